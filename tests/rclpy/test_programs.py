"""Programs written for rclpy."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from graphflow.errors import UsageFault
from graphflow.rclpy.programs import _note_other, _warn_of_build_faults, find_program
from graphflow.transport.rendezvous import free_endpoint
from graphflow.workspace.packages import BUNDLED
from tests.cases import slow

NODE = """
import sys
import rclpy
from rclpy.node import Node
from lamp_interfaces.msg import Light


class Lamp(Node):
    def __init__(self):
        super().__init__("lamp")
        self.declare_parameter("level", 1)
        self.shines = self.create_publisher(Light, "light", 10)
        self.create_subscription(Light, "light", self.seen, 10)
        self.timer = self.create_timer(0.02, self.tick)

    def tick(self):
        self.shines.publish(Light(level=self.get_parameter("level").value))

    def seen(self, light):
        self.get_logger().info(f"{self.get_fully_qualified_name()} shines: {light.level}", once=True)


def main():
    rclpy.init()
    lamp = Lamp()
    print(sys.argv[1:], flush=True)
    try:
        rclpy.spin(lamp)
    except KeyboardInterrupt:
        pass
    finally:
        lamp.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
"""
SETUP = """from setuptools import setup
setup(entry_points={'console_scripts': ['lamp = lamp.node:main', 'none = lamp.no:main']})
"""


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """A workspace with a package of nodes, one of messages, and one of programs."""
    for name in ("lamp", "lamp_interfaces", "tools"):
        (tmp_path / "src" / name).mkdir(parents=True)
        (tmp_path / "src" / name / "package.xml").write_text(f"<package><name>{name}</name></package>")
    lamp = tmp_path / "src" / "lamp"
    (lamp / "lamp").mkdir()
    (lamp / "lamp" / "__init__.py").touch()
    (lamp / "lamp" / "node.py").write_text(NODE)
    (lamp / "lamp" / "ours.py").write_text("from graphflow import Node\n\nclass Ours(Node):\n    pass\n")
    (lamp / "setup.py").write_text(SETUP.replace("]", ", 'ours = lamp.ours:main']"))
    (tmp_path / "src/lamp_interfaces/msg").mkdir()
    (tmp_path / "src/lamp_interfaces/msg/Light.msg").write_text("int32 level\n")
    (tmp_path / "src/tools/scripts").mkdir()
    (tmp_path / "src/tools/scripts/say").write_text("#!/usr/bin/env python3\nimport rclpy\nprint('said')\n")
    return tmp_path


def test_a_program_is_a_file_or_an_executable_of_a_package(workspace: Path) -> None:
    """With the words that are left; what is graphflow's own is none."""
    node = workspace / "src/lamp/lamp/node.py"
    found = find_program("lamp", ["lamp", "--ros-args"], workspace)
    assert found is not None
    assert (found.file, found.entry, found.words) == (node, ("lamp.node", "main"), ["--ros-args"])
    by_file = find_program("src/lamp/lamp/node.py", ["x"], workspace)
    assert by_file is not None
    assert (by_file.file, by_file.entry, set(by_file.workspace.packages)) == (
        node,
        None,
        {"lamp", "lamp_interfaces", "tools"},
    )
    for what, words in (("lamp", ["ours"]), ("lamp_interfaces", []), ("nothing", ["x"]), ("src/lamp/lamp/ours.py", [])):
        assert find_program(what, words, workspace) is None


@pytest.mark.parametrize(
    ("words", "slip"),
    [(["-", "-ros-args", "-r", "a:=b"], ", and write --ros-args"), (["--ros-args", "-r", "a:=b"], "")],
)
def test_a_package_without_an_executable(workspace: Path, words: list[str], slip: str) -> None:
    """Options come after it."""
    with pytest.raises(UsageFault) as caught:
        find_program("lamp", words, workspace)
    assert str(caught.value).startswith(f"name an executable of the package 'lamp' before {words[0]!r}{slip}: ")


def test_an_executable_with_a_suffix(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It is found, and the name that ROS 2 takes is noted, once it runs."""
    found = find_program("lamp", ["lamp.py"], workspace)
    assert found is not None
    assert found.entry == ("lamp.node", "main")
    _warn_of_build_faults(found, "lamp.py")
    assert capsys.readouterr().err == "note: the executable is called lamp; ROS 2 finds no lamp.py\n"


def test_what_a_package_has_not_is_told(workspace: Path) -> None:
    """With what it has; and what it says it has."""
    with pytest.raises(UsageFault, match="'lamp' has no executable 'lmap'; did you mean 'lamp'"):
        find_program("lamp", ["lmap"], workspace)
    (workspace / "src" / "lamp" / "lamp" / "listener.py").touch()
    line = r"listener\.py is there: add 'listener = lamp\.listener:main', to the console_scripts of .*/lamp/setup\.py"
    with pytest.raises(UsageFault, match=line):
        find_program("lamp", ["listener"], workspace)
    (workspace / "src" / "lamp" / "launch").mkdir()
    (workspace / "src" / "lamp" / "launch" / "lamp.launch.py").touch()
    with pytest.raises(UsageFault, match=r"'lamp.launch.py'; to start it: graphflow launch lamp lamp\.launch\.py$"):
        find_program("lamp", ["lamp.launch.py"], workspace)
    with pytest.raises(UsageFault, match="name an executable of the package 'lamp': lamp, none, ours"):
        find_program("lamp", [], workspace)
    with pytest.raises(UsageFault, match=r"none is lamp\.no:main, and there is no"):
        find_program("lamp", ["none"], workspace)
    setup = workspace / "src/lamp/setup.py"
    setup.write_text(SETUP.replace("]", " 'ours = lamp.ours:main']"))
    with pytest.raises(UsageFault, match=r"no executable 'ours'.*setup\.py:2: .* a comma is missing"):
        find_program("lamp", ["ours"], workspace)


def test_another_package_with_the_same_modules(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The file that runs instead is named, and so is a copy of the package that is not used."""
    found = find_program("lamp", ["lamp"], workspace)
    assert found is not None
    _note_other(found, str(found.file))
    assert capsys.readouterr().err == ""
    copied = shutil.copytree(workspace / "src" / "lamp", workspace / "src" / "lamp_copy")
    other = copied / "lamp" / "node.py"
    found = find_program("lamp", ["lamp"], workspace)
    assert found is not None
    _note_other(found, str(other))
    first, second = capsys.readouterr().err.splitlines()
    assert first.startswith(f"note: this runs {other}, and not {found.file}: two packages have a folder lamp for")
    assert second.startswith(f"note: {copied} is not used, since {workspace}/src/lamp is called 'lamp', too; rename ")


def start(workspace: Path, *words: str) -> subprocess.Popen[str]:
    env = {**os.environ, "GRAPHFLOW_RENDEZVOUS": free_endpoint(), "PYTHONUNBUFFERED": "1"}
    command = [sys.executable, "-m", "graphflow.rclpy", *words]
    return subprocess.Popen(
        command, cwd=workspace, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )


@slow
@pytest.mark.real
def test_a_main_that_nothing_calls(workspace: Path) -> None:
    """Is told at the end of the program, once."""
    node = workspace / "src/lamp/lamp/node.py"
    node.write_text(NODE.partition("if __name__")[0])
    process = start(workspace, str(node))
    try:
        assert process.communicate(timeout=20)[0].endswith(
            "node.py:23: main() is defined and never called; add as the last line: if __name__ == '__main__': main()\n"
        )
    finally:
        process.kill()
        process.wait()


@slow
@pytest.mark.real
def test_a_module_that_a_build_would_leave_out(workspace: Path) -> None:
    """Runs, and is told."""
    lamp = workspace / "src/lamp"
    (lamp / "lamp/__init__.py").unlink()
    (lamp / "lamp/node.py").write_text("def main():\n    print('ran')\n")
    (lamp / "setup.py").write_text(SETUP.replace("setup(", "setup(packages=find_packages(), "))
    process = start(workspace, "lamp", "lamp")
    try:
        told, ran = process.communicate(timeout=20)[0].splitlines()
        assert told.startswith(f"note: {lamp / 'lamp'} has no __init__.py: find_packages() in")
        assert ran == "ran"
    finally:
        process.kill()
        process.wait()


@pytest.mark.real
@pytest.mark.parametrize("words", [("lamp", "lamp"), ("src/lamp/lamp/node.py",)])
def test_it_runs_as_it_stands(workspace: Path, words: tuple[str, ...]) -> None:
    """With messages of its workspace, and what the command line says; Ctrl-C ends it cleanly."""
    process = start(workspace, *words, "mine", "--ros-args", "-r", "__ns:=/attic", "-p", "level:=7")
    lines: list[str] = []
    assert process.stdout is not None
    try:
        for line in process.stdout:
            lines.append(line)
            if "shines: 7" in line:
                process.send_signal(signal.SIGINT)
        assert process.wait(20) == 0
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
    assert lines[0] == "['mine', '--ros-args', '-r', '__ns:=/attic', '-p', 'level:=7']\n"
    assert [line for line in lines if "[attic.lamp]: /attic/lamp shines: 7" in line]
    assert len(lines) == 2


@pytest.mark.real
def test_an_interrupted_program_shows_its_own_lines(workspace: Path) -> None:
    """Not those by which its callbacks are run."""
    program = workspace / "busy.py"
    busy = NODE.replace("except KeyboardInterrupt:\n        pass\n    ", "").replace(
        "once=True)", "once=True)\n        rclpy.spin(self)"
    )
    program.write_text(busy)
    process = start(workspace, "busy.py")
    assert process.stdout is not None
    try:
        for line in process.stdout:
            if "shines: 1" in line:
                process.send_signal(signal.SIGINT)
                break
        shown = process.stdout.read()
        assert process.wait(20) == -signal.SIGINT
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
    files = [line.strip() for line in shown.splitlines() if line.startswith("  File")]
    assert files
    assert all(line.startswith(f'File "{program}"') for line in files)
    assert shown.splitlines()[-1] == "KeyboardInterrupt"


_INTERRUPTED = """
import os, signal, sys
signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT,))
os.kill(os.getpid(), signal.SIGINT)
os.execv(sys.executable, [sys.executable, "-m", "graphflow.rclpy", "lamp", "lamp"])
"""


@pytest.mark.real
@pytest.mark.skipif(sys.platform == "win32", reason="signals are not blocked there")
def test_it_is_interrupted_before_it_begins(workspace: Path) -> None:
    """`graphflow run` keeps Ctrl-C back while the interpreter starts; then it ends the process without a word."""
    command = [sys.executable, "-c", _INTERRUPTED]
    ended = subprocess.run(command, cwd=workspace, capture_output=True, text=True, timeout=20, check=False)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")


def test_programs_that_come_with_graphflow(workspace: Path) -> None:
    """They are found anywhere, unless the workspace has a package of that name."""
    found = find_program("tf2_ros", ["tf2_echo", "map", "base"], workspace)
    assert found is not None
    assert (found.file, found.words) == (BUNDLED / "tf2_ros/programs/tf2_echo.py", ["map", "base"])
    with pytest.raises(UsageFault, match="did you mean 'tf2_echo'"):
        find_program("tf2_ros", ["tf2_eco"], workspace)
    (workspace / "src/tools/package.xml").write_text("<package><name>tf2_ros</name></package>")
    found = find_program("tf2_ros", ["say"], workspace)
    assert found is not None
    assert found.file == workspace / "src/tools/scripts/say"


@slow
@pytest.mark.real
def test_what_comes_with_graphflow_runs(workspace: Path) -> None:
    """From a folder that knows nothing of it."""
    process = start(workspace, "tf2_ros", "tf2_echo", "map")
    output, _ = process.communicate(timeout=20)
    assert "the following arguments are required: target_frame" in output
    assert process.returncode == 2


@slow
@pytest.mark.real
def test_source_trees_of_what_graphflow_has(workspace: Path) -> None:
    """They are not imported, and a note says so; the programs of the workspace run."""
    for name in ("rclpy", "tf2_py"):
        (workspace / "src" / name / name).mkdir(parents=True)
        (workspace / "src" / name / "package.xml").write_text(f"<package><name>{name}</name></package>")
        (workspace / "src" / name / name / "__init__.py").write_text("raise ImportError")
    file = workspace / "uses.py"
    file.write_text("import rclpy, tf2_py\nprint(rclpy.__name__, tf2_py.__name__)\n")
    command = [sys.executable, "-m", "graphflow.rclpy", str(file)]
    ran = subprocess.run(command, cwd=workspace, capture_output=True, text=True, timeout=30, check=True)
    assert ran.stdout == "rclpy tf2_py\n"
    notes = [
        f"{workspace}/src/{name}/{name} is not imported: graphflow has {name} itself" for name in ("rclpy", "tf2_py")
    ]
    assert ran.stderr.splitlines() == [f"note: {note}" for note in notes]


@slow
def test_messages_of_messages(workspace: Path) -> None:
    """Those of another package of the workspace, which nobody has imported; one that is not there is named."""
    folder = workspace / "src/room_interfaces"
    (folder / "msg/parts").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>room_interfaces</name></package>")
    (folder / "msg/Room.msg").write_text("lamp_interfaces/Light lamp\nWall wall\n")
    (folder / "msg/parts/Wall.msg").write_text("int8 x\n")
    (folder / "msg/Bad.msg").write_text("no_interfaces/Light lamp\n")
    for name, said in (("Room", "lamp=lamp_interfaces.msg.Light(level=0), wall="), ("Bad", "'no_interfaces'")):
        use = f"import rclpy\nfrom room_interfaces.msg import {name}\nprint({name}())\n"
        (workspace / "src/tools/scripts/say").write_text(f"#!/usr/bin/env python3\n{use}")
        output, _ = start(workspace, "tools", "say").communicate(timeout=20)
        assert said in output


@slow
@pytest.mark.real
def test_a_field_that_does_not_fit_is_told_with_what_ros_does(workspace: Path) -> None:
    """Which looks later."""
    use = "import rclpy\nfrom lamp_interfaces.msg import Light\nLight(level='a')\n"
    (workspace / "src/tools/scripts/say").write_text(f"#!/usr/bin/env python3\n{use}")
    output, _ = start(workspace, "tools", "say").communicate(timeout=20)
    assert output.strip().rpartition("\n")[2].endswith("ROS_PYTHON_CHECK_FIELDS=0")


@slow
@pytest.mark.real
def test_modules_of_rclpy_are_there_with_it(workspace: Path) -> None:
    """Programs use them that import rclpy alone; what is none is none."""
    use = "import rclpy\nprint(rclpy.exceptions.InvalidHandle.__name__, hasattr(rclpy, 'nodes'), rclpy.node.Node)\n"
    (workspace / "src/tools/scripts/say").write_text(f"#!/usr/bin/env python3\n{use}")
    output, _ = start(workspace, "tools", "say").communicate(timeout=20)
    assert output == "InvalidHandle False <class 'rclpy.node.Node'>\n"


@slow
@pytest.mark.real
def test_a_package_of_a_name_of_ros(workspace: Path) -> None:
    """It hides the other, which is told in place of what it lacks."""
    own = workspace / "src" / "std_msgs"
    (own / "std_msgs").mkdir(parents=True)
    (own / "package.xml").write_text("<package><name>std_msgs</name></package>")
    (own / "std_msgs" / "__init__.py").touch()
    (workspace / "src" / "lamp" / "lamp" / "late.py").write_text(
        "import rclpy\nfrom std_msgs.msg import String\ndef main(): ...\n"
    )
    (workspace / "src" / "lamp" / "setup.py").write_text(SETUP.replace("lamp.no:main", "lamp.late:main"))
    said, _ = start(workspace, "lamp", "none").communicate(timeout=20)
    assert said.endswith(f"note: your package {own} hides ROS 2's std_msgs; rename yours, there and in its files\n")


@slow
@pytest.mark.real
def test_a_file_of_a_name_of_ros(workspace: Path) -> None:
    """It is named before it runs, and where the error is shown."""
    (workspace / "std_msgs.py").write_text("import rclpy\nfrom std_msgs.msg import String\n")
    told = start(workspace, "std_msgs.py").communicate(timeout=30)[0]
    note = f"note: {workspace}/std_msgs.py hides the package std_msgs: rename it, as in my_std_msgs.py"
    first, *_, last = told.splitlines()
    assert (first, last) == (note, note)


@pytest.mark.real
def test_scripts_run_and_mistakes_end_with_2(workspace: Path) -> None:
    """And a sentence."""
    for words, code, text in (
        (("tools", "say"), 0, "said\n"),
        (("lamp", "lmap"), 2, "error: package 'lamp' has no executable 'lmap'; did you mean 'lamp'?\n"),
        (("nothing",), 2, "error: nothing is not a program that uses rclpy\n"),
    ):
        process = start(workspace, *words)
        output, _ = process.communicate(timeout=20)
        assert (output, process.returncode) == (text, code)


@slow
@pytest.mark.real
@pytest.mark.parametrize(
    ("line", "told", "note"),
    [
        (
            "import lampp",
            ["Traceback", "lamp/late.py", "    import lampp"],
            "there is no lampp here; did you mean 'lamp'?",
        ),
        ("import lamp.no", ["Traceback", "lamp/late.py", "    import lamp.no"], "lamp has no module lamp.no"),
        (
            "from lamp.msg import A",
            ["Traceback", "lamp/late.py", "    from lamp.msg"],
            "lamp has no .msg file; they are in lamp_interfaces",
        ),
        ("from rclpy.Node import Node", ["Traceback"], "there is no module rclpy.Node; did you mean 'rclpy.node'?"),
        (
            "from turtlesim.msgs import Pose",
            ["Traceback"],
            "there is no module turtlesim.msgs; did you mean 'turtlesim.msg'?",
        ),
        ("import later", ["Traceback"], "later.py is in the package lamp; write: from lamp.later import ..."),
        ("def main(:", ["  File", "lamp/late.py", "    def main("], ""),
        ("1 / 0", ["Traceback", "lamp/late.py", "    1 / 0"], ""),
    ],
)
def test_an_error_is_shown_from_the_programs_own_code_on(
    workspace: Path, line: str, told: list[str], note: str
) -> None:
    """With what may help, and none of what has started it."""
    (workspace / "src" / "lamp" / "lamp" / "late.py").write_text(f"import rclpy\n{line}\ndef main(): ...\n")
    (workspace / "src" / "lamp" / "lamp" / "later.py").touch()
    (workspace / "src" / "lamp" / "setup.py").write_text(SETUP.replace("lamp.no:main", "lamp.late:main"))
    run = start(workspace, "lamp", "none")
    said, _ = run.communicate(timeout=20)
    lines = said.splitlines()
    assert run.returncode == 1
    assert all(text in "\n".join(lines[:3]) for text in told)
    assert lines[-1].startswith(f"note: {note}") if note else "note" not in said
    assert "graphflow" not in said


@slow
def test_a_program_without_an_end_of_its_own_ends_too() -> None:
    """A node that nobody has destroyed, and a context that nobody has shut down."""
    code = (
        "from graphflow.rclpy import enabling; enabling.here(); import rclpy; from rclpy.node import Node; "
        "rclpy.init(); node = Node('left'); print('left')"
    )
    env = {**os.environ, "GRAPHFLOW_RENDEZVOUS": free_endpoint()}
    ended = subprocess.run(
        [sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=30, check=False
    )
    assert (ended.stdout, ended.stderr, ended.returncode) == ("left\n", "", 0)


@slow
@pytest.mark.parametrize(
    "order", ["import rclpy", "import atexit; atexit.register(lambda: end())"], ids=["first", "last"]
)
def test_a_daemon_that_spins_can_be_waited_for_at_the_end(order: str) -> None:
    """By what the program has registered, whether that is called before the context is left or after it."""
    code = (
        "from graphflow.rclpy import enabling; enabling.here()\n"
        f"{order}\n"
        "import atexit, threading, rclpy; from rclpy.node import Node\n"
        "def end(): thread.join(20); print(thread.is_alive())\n"
        f"{'atexit.register(end)' if order == 'import rclpy' else ''}\n"
        "rclpy.init(); node = Node('left')\n"
        "thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True); thread.start()\n"
        f"{'rclpy.shutdown()' if order == 'import rclpy' else ''}\n"
    )
    env = {**os.environ, "GRAPHFLOW_RENDEZVOUS": free_endpoint()}
    ended = subprocess.run(
        [sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=30, check=False
    )
    assert (ended.stdout, ended.returncode) == ("False\n", 0), ended.stderr


@slow
def test_a_thread_that_spins_outlives_the_main_thread() -> None:
    """Its callbacks run until a signal ends it; the network is left then."""
    code = (
        "from graphflow.rclpy import enabling; enabling.here()\n"
        "import os, signal, threading, rclpy; from rclpy.node import Node\n"
        "def tick():\n"
        "    if not threading.main_thread().is_alive():\n"
        "        print('alone', rclpy.ok(), flush=True); timer.cancel(); os.kill(os.getpid(), signal.SIGINT)\n"
        "rclpy.init(); node = Node('left'); timer = node.create_timer(0.05, tick)\n"
        "threading.Thread(target=rclpy.spin, args=(node,), name='spinner').start()\n"
    )
    env = {**os.environ, "GRAPHFLOW_RENDEZVOUS": free_endpoint()}
    ended = subprocess.run(
        [sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=30, check=False
    )
    last = "Exception in thread spinner:\nrclpy.executors.ExternalShutdownException\n"
    assert (ended.stdout, ended.stderr, ended.returncode) == ("alone True\n", last, 0)
