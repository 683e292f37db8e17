"""`graphflow run`: one node in a terminal."""

from __future__ import annotations

import shutil
import signal
import time
from pathlib import Path

import pytest

from graphflow.runtime.ending import SAME_SIGNAL
from tests.cases import sample, slow
from tests.conftest import PROGRAMS, Machine

pytestmark = pytest.mark.real


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_a_node_cleanly(machine: Machine, number: int) -> None:
    """No traceback, exit code 0."""
    node = machine.start("run", "nodes.talker:Talker", "--ros-args", "-p", "rate:=20.0")
    node.wait_for("Hello World: 3")
    assert node.end(number) == 0
    assert "Traceback" not in node.text
    assert "Error" not in node.text


@slow
def test_a_script_that_runs_a_node_ends_as_cleanly(machine: Machine) -> None:
    """`graphflow.run(Talker)` in a file of one's own is the same."""
    node = machine.start_python("-m", "nodes.talker", "--ros-args", "-p", "rate:=20.0", "-r", "chatter:=/news")
    node.wait_for("Hello World: 3")
    assert "/news" in machine.run("topic", "list")
    assert node.end() == 0
    assert "Traceback" not in node.text


@slow
def test_remaps_and_namespace_reach_the_graph(machine: Machine) -> None:
    """__ns, __node, a remap rule and a parameter take effect, with or without --ros-args."""
    node = machine.start(
        "run", "nodes.talker:Talker", "__ns:=/robot", "__node:=voice", "chatter:=said", "-p", "rate:=20.0"
    )
    node.wait_for("Publishing")
    assert machine.run("node", "list").split() == ["/robot/voice"]
    assert "/robot/said [std_msgs/msg/String]" in machine.run("topic", "list", "-t")
    assert node.end() == 0


@slow
def test_a_name_that_is_taken_is_refused(machine: Machine) -> None:
    """Two nodes of one name would answer each other's parameter calls."""
    node = machine.start("run", "nodes.talker:Talker", "-p", "rate:=20.0")
    node.wait_for("Publishing")
    text = machine.run("run", "nodes.talker:Talker", code=1)
    assert f"process {node.pid}" in text
    assert "-r __node:=NAME" in text


@slow
@pytest.mark.parametrize(
    ("words", "code", "expected"),
    sample(
        [
            (["nodes.talker.Talker"], 2, "write MODULE:CLASS, nodes.talker:Talker"),
            (["nodes.talkr:Talker"], 2, "there is no module 'nodes.talkr'"),
            (["topic", "list"], 2, "'topic' is a command of its own: graphflow topic list"),
            (["nodes.talker:Talkr"], 2, "did you mean 'Talker'?"),
            (["nodes.talker:Talker", "-p", "rtae:=2.0"], 2, "did you mean 'rate'?"),
            (["nodes.talker:Talker", "-p", "rate:=fast"], 2, "parameter 'rate' is of type double, 'fast' is not"),
            (["nodes.talker:Talker", "-p", "rate:=-1.0"], 2, "out of range"),
            (["nodes.talker:Talker", "-r", "___ns:=/turtle1"], 2, "did you mean '__ns:=/turtle1'?"),
            (["nodes.talker:Talker", "--ros-args", "-r"], 2, "needs a value"),
            (["nodes.talker:Talker", "--log-level", "loud"], 2, "is not a log level"),
            (["nodes.talker:Talker", "--rate", "5.0"], 2, "nothing reads the option '--rate'; to set the parameter"),
            (["--rate", "5.0", "nodes.talker:Talker"], 2, "run has no option '--rate'"),
        ]
    ),
)
def test_what_is_wrong_is_said_in_a_line(machine: Machine, words: list[str], code: int, expected: str) -> None:
    """An error is one helpful sentence without a traceback."""
    text = machine.run("run", *words, code=code)
    assert expected in text
    assert "Traceback" not in text
    assert text.count("\n") == 1


@slow
def test_an_error_of_the_users_own_code_shows_its_traceback(machine: Machine, tmp_path: Path) -> None:
    """Whatever the user's code raises reaches the user."""
    shutil.copy(PROGRAMS / "run" / "no_camera.py", tmp_path)
    text = machine.run("run", "no_camera:NoCamera", cwd=tmp_path, code=1)
    assert "LookupError: no such camera" in text
    assert "no_camera.py" in text


def test_bundled_nodes_run_from_anywhere(machine: Machine, tmp_path: Path) -> None:
    """Bundled nodes are found outside any project, with a note."""
    node = machine.start("run", "nodes.talker:Talker", "-p", "rate:=20.0", cwd=tmp_path)
    node.wait_for("Publishing")
    assert "comes with graphflow" in node.text
    assert node.end() == 0


@slow
def test_words_of_its_own_reach_the_program(machine: Machine, tmp_path: Path) -> None:
    """Other words are in sys.argv, without those for ROS, as with `ros2 run`."""
    (tmp_path / "adder.py").write_text(
        "import sys\nfrom graphflow import Node\nclass Adder(Node):\n"
        "    async def on_start(self):\n        self.log.info(f'{self.name} {sys.argv[1:]}')\n        self.shutdown()\n"
    )
    text = machine.run("run", "adder.py", "2", "--fast", "--ros-args", "-r", "__node:=plus", cwd=tmp_path)
    assert "plus ['2', '--fast']" in text


@slow
@pytest.mark.parametrize("name", ["turtle_follower", "scheduler"])
def test_a_bundled_node_beside_a_projects_own(machine: Machine, tmp_path: Path, name: str) -> None:
    """A project's file does not affect a bundled node of the same name, which brings its own interfaces."""
    (tmp_path / "nodes").mkdir()
    (tmp_path / "nodes" / "__init__.py").touch()
    (tmp_path / "nodes" / "position_controller.py").write_text("raise RuntimeError('mine')\n")
    node = machine.start("run", name, cwd=tmp_path)
    node.wait_for("comes with graphflow")
    node.wait_for(f"{name}.py")
    assert node.end() == 0
    assert "mine" not in node.text


@slow
def test_a_process_ends_though_its_session_was_never_closed(machine: Machine) -> None:
    """An uncaught exception ends a program that has subscribed: Zenoh's threads do not keep it alive."""
    program = machine.start_python(str(PROGRAMS / "run" / "careless.py"))
    assert program.wait() == 3


@slow
def test_ctrl_c_does_not_wait_for_a_blocked_thread(machine: Machine, tmp_path: Path) -> None:
    """A body that blocks in a thread cannot be cancelled; the process ends without it."""
    shutil.copy(PROGRAMS / "run" / "slow.py", tmp_path)
    node = machine.start("run", "slow:Slow", cwd=tmp_path)
    node.wait_for("at work")
    assert node.end() == 0


@slow
def test_a_second_ctrl_c_ends_a_node_whose_handler_never_returns(machine: Machine, tmp_path: Path) -> None:
    """A handler that blocks the loop cannot be cancelled: the second Ctrl-C ends the process."""
    shutil.copy(PROGRAMS / "run" / "stuck.py", tmp_path)
    node = machine.start("run", "stuck:Stuck", cwd=tmp_path)
    node.wait_for("at work")
    node.process.send_signal(signal.SIGINT)
    status = Path(f"/proc/{node.pid}/status")
    machine.until(lambda: "ShdPnd:\t0000000000000000" in status.read_text(), "the first signal has arrived")
    time.sleep(2 * SAME_SIGNAL)  # signals that come together count as one, by the node's own clock
    assert node.end() == 1
    assert "asked twice; it was in " in node.text
    assert "stuck.py" in node.text.splitlines()[-1]


@slow
def test_signals_that_come_together_are_one(machine: Machine) -> None:
    """Signals in quick succession count as one: `timeout` signals its child and then the whole group."""
    node = machine.start("run", "nodes.talker:Talker")
    node.wait_for("Publishing")
    node.process.send_signal(signal.SIGTERM)
    assert node.end() == 0
    assert "asked twice" not in node.text


@slow
def test_a_forgotten_super_is_named(machine: Machine, tmp_path: Path) -> None:
    """The likeliest mistake in a constructor is explained in one sentence."""
    shutil.copy(PROGRAMS / "run" / "bare.py", tmp_path)
    text = machine.run("run", "bare:Bare", cwd=tmp_path, code=2)
    assert text == "error: Bare.__init__ (bare.py:11) must call super().__init__()\n"


@slow
def test_a_command_before_it(machine: Machine) -> None:
    """A prefix such as a debugger is run before the node; a missing one is an error."""
    program = machine.start("run", "--prefix", "env GREETING=1", "demo_nodes_cpp", "talker")
    program.wait_for("Hello World: 1")
    assert program.end(signal.SIGINT) == 0
    words = ("run", "--prefix", "no-such-program -x", "demo_nodes_cpp", "talker")
    assert "there is no program 'no-such-program' on the PATH" in machine.run(*words, code=2)


@slow
@pytest.mark.parametrize(
    ("words", "told"),
    [
        (
            ["_rate:=2.0"],
            "error: the remap _rate:=2.0 matches no name of this node; to set the parameter write -p rate:=2.0",
        ),
        (["-r", "foo:=/news"], "error: the remap foo:=/news matches no name of this node; there is chatter"),
        (["-r", "**/chattr:=/news"], "error: the remap **/chattr:=/news matches no name of this node"),
        (["-r", "__node:=my", "turtle"], "quote a value that contains a space: -r '__node:=my turtle'"),
        (["-r", "__node:=my turtle"], "'my turtle' is not a node name: use letters, digits and _, and do not begin"),
        (["-r", "rate:=5.0"], "to set the parameter write -p rate:=5.0"),
    ],
)
def test_a_remap_that_cannot_be(machine: Machine, words: list[str], told: str) -> None:
    """A remap rule that matches nothing is an error with exit code 2; ROS 2 would silently ignore it."""
    assert told in machine.run("run", "talker", "--ros-args", *words, code=2)


@slow
def test_a_launch_file(machine: Machine, tmp_path: Path) -> None:
    """Running it would only define a function: the error names the verb that starts it."""
    file = tmp_path / "robot.launch.py"
    file.write_text("def generate_launch_description():\n    pass\n")
    assert f"is a launch file; run it with: graphflow launch {file}" in machine.run("run", str(file), code=2)


def test_a_prefix_that_is_none(machine: Machine) -> None:
    """An invalid prefix is an error with the reason."""
    assert "No closing quotation" in machine.look("run", "--prefix", "a'b", "demo_nodes_cpp", "talker", code=2)


@slow
def test_where_logs_go(machine: Machine) -> None:
    """Options turn off logs to the terminal and to /rosout."""
    listener = machine.start("run", "listener")
    node = machine.start("run", "talker", "--ros-args", "-p", "rate:=20.0", "--disable-stdout-logs")
    listener.wait_for("Hello World")
    assert "/rosout" in machine.look("node", "info", "/talker")
    assert node.end() == 0
    assert "Hello World" not in node.text
    assert listener.end() == 0
    node = machine.start("run", "talker", "--ros-args", "-p", "rate:=20.0", "--disable-rosout-logs")
    node.wait_for("Hello World: 2")
    assert "/rosout" not in machine.look("node", "info", "/talker")
    assert node.end() == 0


@slow
def test_a_file_that_runs_itself(machine: Machine, tmp_path: Path) -> None:
    """A file that calls `graphflow.run` for itself is run as a program, with the command's arguments."""
    (tmp_path / "one.py").write_text(
        "import graphflow\n\n\nclass Talk(graphflow.Node):\n"
        "    async def on_start(self) -> None:\n        self.log.info('I am here')\n\n\ngraphflow.run(Talk)\n"
    )
    program = machine.start("run", "one.py", "-r", "__node:=other", cwd=tmp_path)
    program.wait_for("[other]: I am here")
    assert program.end() == 0
