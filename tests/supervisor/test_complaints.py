"""Long-standing complaints about ROS 2's launch, and the behaviour here."""

from __future__ import annotations

import re
import signal
from pathlib import Path

import psutil
import pytest

from graphflow.system import is_portable
from tests.cases import slow, some
from tests.conftest import Machine, alive
from tests.supervisor.running import nothing_is_left, rows, write

pytestmark = pytest.mark.real

QUIET = """
nodes:
  /quiet: {class: nodes.lab:Good}
  /shell: {command: [sh, -c, "trap '' TERM; sleep 600 & sleep 601"]}
"""
TWO = """
nodes:
  /a: {class: nodes.talker:Talker}
  /b: {class: nodes.listener:Listener, remap: {chatter: news}}
"""


@slow
@pytest.mark.skipif(is_portable(), reason="the portable way has no signals for groups of processes")
@pytest.mark.parametrize("number", some(["SIGINT", "SIGTERM", "SIGHUP"], "SIGINT"))
def test_the_end_of_a_graph(machine: Machine, project: Path, number: str) -> None:
    """A signal to the command alone ends all: quiet nodes, a shell that ignores SIGTERM, and what that has started.

    launch#495 (a SIGINT to launch alone), #545 and #632 (shells and grandchildren live on), #666 (SIGTERM reaches
    nobody), launch_ros#199 (a quiet child is waited for).
    """
    up = machine.start("up", "--no-console", write(project, QUIET), cwd=project)
    up.wait_for("is up")
    everybody = [child.pid for child in psutil.Process(up.pid).children(recursive=True)]
    assert len(everybody) >= 5
    up.process.send_signal(getattr(signal, number))
    up.process.wait(15.0)
    nothing_is_left(machine, everybody)
    assert "Traceback" not in up.text


@slow
@pytest.mark.skipif(is_portable(), reason="the portable way has no signals for groups of processes")
def test_an_impatient_end(machine: Machine, project: Path) -> None:
    """A second Ctrl-C kills at once what does not want to end; nothing hangs. launch#207."""
    up = machine.start("up", "--no-console", write(project, QUIET), cwd=project)
    up.wait_for("is up")
    everybody = [child.pid for child in psutil.Process(up.pid).children(recursive=True)]
    up.process.send_signal(signal.SIGINT)
    up.wait_for("stopping")
    up.process.send_signal(signal.SIGINT)
    up.process.wait(4.0)  # less than the five seconds that a node has to end by itself
    nothing_is_left(machine, everybody)


@slow
def test_one_node_of_a_running_graph(machine: Machine, project: Path) -> None:
    """It is stopped, started and restarted while the others go on. launch#32."""
    machine.run("up", "-d", write(project, TWO), cwd=project)
    pids = {name: row["pid"] for name, row in rows(machine).items()}
    machine.look("stop", "/a")
    assert not alive(pids["/a"])
    assert "/a is not running" in machine.look("stop", "/a", code=1)
    machine.look("start", "/a")
    assert "/a runs already" in machine.look("start", "/a", code=1)
    first = rows(machine)["/a"]["pid"]
    machine.look("restart", "/a")
    now = {name: row["pid"] for name, row in rows(machine).items()}
    assert now["/b"] == pids["/b"]
    assert len({pids["/a"], first, now["/a"]}) == 3


@slow
@pytest.mark.parametrize("section", ["/tlaker", "/room/talker"])
def test_a_parameter_file_for_nobody(machine: Machine, project: Path, section: str) -> None:
    """Its place and the name that was meant are told, and nothing starts. ros2#569, rcl#954, ros2cli#648."""
    (project / "params.yaml").write_text(f"{section}:\n  ros__parameters: {{rate: 5.0}}\n")
    text = "nodes:\n  /talker: {class: nodes.talker:Talker, params_file: params.yaml}\n"
    told = machine.run("up", "-d", write(project, text), cwd=project, code=2)
    assert "params.yaml" in told
    assert "/talker" in told
    assert "nothing was started" in told


@slow
@pytest.mark.parametrize(
    ("remap", "told"),
    [
        ("{chater: news}", "Talker has no topic or service 'chater'; did you mean 'chatter'?"),
        ("{/talker/chatter: news}", "Talker has no topic or service '/talker/chatter'"),
    ],
)
def test_a_remap_of_nothing(machine: Machine, project: Path, remap: str, told: str) -> None:
    """Is a mistake with its place. ros2#1235, rcl#561."""
    text = f"nodes:\n  /talker:\n    class: nodes.talker:Talker\n    remap: {remap}\n"
    assert re.search(
        rf"lab.yaml:4:\d+: {re.escape(told)}", machine.look("check", write(project, text), cwd=project, code=2)
    )


@slow
def test_where_a_name_comes_from(machine: Machine, project: Path) -> None:
    """The namespace and the rule, each with its line. navigation2#3935."""
    text = "group:\n  namespace: room\n  nodes:\n    b: {class: nodes.listener:Listener, remap: {chatter: news}}\n"
    told = machine.look("explain", write(project, text), "/room/news", cwd=project)
    assert "by the namespace /room" in told
    assert "by the remap chatter:=news (lab.yaml:4:" in told


@slow
def test_two_nodes_of_one_name(machine: Machine, project: Path) -> None:
    """In one file, in two graphs, and by hand: the second is refused, and says who has the name. launch_ros#124."""
    twice = "nodes:\n  /talker: {class: nodes.talker:Talker}\n  talker: {class: nodes.listener:Listener}\n"
    assert "/talker" in machine.look("check", write(project, twice, "twice.yaml"), cwd=project, code=2)
    machine.run("up", "-d", write(project, TWO), cwd=project)
    other = write(project, "nodes:\n  /b: {class: nodes.listener:Listener}\n", "other.yaml")
    told = machine.run("up", "-d", other, cwd=project, code=1)
    assert f"/b (process {rows(machine)['/b']['pid']}" in told
    assert "rename the node in the graph file" in told
    words = ("run", "nodes.listener:Listener", "--ros-args", "-r", "__node:=b")
    assert "start this one with -r __ns:=/NAME, or -r __node:=NAME" in machine.run(*words, cwd=project, code=1)


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        (
            "a.launch.yaml",
            "launch:\n- node: {pkg: turtlesim, exec: turtlesim_node, nmae: sim}\n",
            "a.launch.yaml:2:48: node: unknown attribute 'nmae'; did you mean 'name'?",
        ),
        (
            "a.launch.xml",
            '<launch>\n  <node pkg="turtlesim" exec="turtlesim_node" nmae="sim"/>\n</launch>\n',
            "a.launch.xml:2",
        ),
        ("a.launch.xml", "<launch>\n  <node pkg='turtlesim'>\n</launch>\n", "a.launch.xml:3"),
        ("a.launch.yaml", "launch:\n- nod: {pkg: turtlesim}\n", "did you mean 'node'?"),
    ],
)
def test_mistakes_in_a_launch_file(machine: Machine, project: Path, name: str, text: str, told: str) -> None:
    """File, line and the word that was meant, and no traceback. launch#412, launch#645."""
    out = machine.look("check", write(project, text, name), cwd=project, code=2)
    assert told in out
    assert "Traceback" not in out


@slow
def test_what_follows_an_end_is_said_in_yaml(machine: Machine, project: Path) -> None:
    """One node after another's end, and the end of all with one node: for which ROS 2 needs Python. launch_ros#236."""
    text = """
nodes:
  /first: {command: [sh, -c, "echo first"]}
  /second: {command: [sh, -c, "echo second"], after: {/first: done}, on_exit: shutdown}
  /others: {class: nodes.lab:Good}
"""
    out = machine.run("up", "--no-console", write(project, text), cwd=project, code=None)
    assert out.index("first") < out.index("second")
    assert "/second has ended" in out
