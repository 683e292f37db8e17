"""Foreign programs in a graph: started, logged, asked to end, and never left behind."""

from __future__ import annotations

import math
import os
import signal
import sys
from pathlib import Path
from typing import Any

import psutil
import pytest

from graphflow.errors import Place
from graphflow.graph.plan import PlannedNode, Rule, Setting
from graphflow.runtime.args import parse_ros_args
from graphflow.supervisor.launching.programs import command_of
from graphflow.system import is_portable
from tests.cases import slow, some
from tests.conftest import Machine, alive
from tests.supervisor.running import nothing_is_left, rows, supervisor_of, write

pytestmark = pytest.mark.real

SHELL = """\
nodes:
  /a: {class: nodes.lab:Good}
  /p:
    command: [sh, -c, 'trap "echo cleaned up; exit 0" TERM; echo "$COLOUR here"; sleep 600 & wait']
    env: {COLOUR: red}
    after: /a
"""


HERE = Place("g.yaml", 1, 1)


def executable(name: str, **settings: Any) -> PlannedNode:
    return PlannedNode(name, "", HERE, HERE, command=("graphflow", "run", "p", "e", "-x"), executable="p e", **settings)


@pytest.mark.parametrize(
    ("node", "words"),
    [
        (executable("/a"), ["-r", "__node:=a"]),
        (executable("/n/m/a"), ["-r", "__node:=a", "-r", "__ns:=/n/m"]),
        (executable("/n/a", keeps_names=True), ["-r", "__ns:=/n"]),
        (executable("/a", keeps_names=True, params_files=("f.yaml",)), ["--params-file", "f.yaml"]),
        (executable("/a", keeps_names=True, log_level="warn"), ["--log-level", "warn"]),
        (executable("/a", keeps_names=True, remaps=(Rule("x", "/y", HERE),)), ["-r", "x:=/y"]),
        *(
            (executable("/a", keeps_names=True, params={"p": Setting(value, HERE)}), ["-p", f"p:={word}"])
            for value, word in [
                (3, "3"),
                (1e-05, "1e-05"),
                (math.inf, ".inf"),
                (True, "true"),
                ("5", "'5'"),
                ("true", "'true'"),
                ("a b", "a b"),
                (["x", "1"], "[x, '1']"),
                ([0.5, -math.inf], "[0.5, -.inf]"),
            ]
        ),
    ],
)
def test_command_of_an_executable(node: PlannedNode, words: list[str]) -> None:
    """Its own words, then what the graph file gives it, as ROS 2's; values read back as what they are."""
    program, given = command_of(node)[:4], command_of(node)[4:]
    assert program == [sys.executable, "-P", "-m", "graphflow.rclpy"]
    assert given == ["p", "e", "-x", "--ros-args", *words]
    [(_, _, read, _)] = parse_ros_args(given).params or [(None, "", None, "")]
    assert [read] == ([setting.value for setting in node.params.values()] or [None])


def test_command_of_a_program() -> None:
    """As they are written, unless it is graphflow itself, which need not be on the PATH."""
    assert command_of(PlannedNode("/a", "", HERE, HERE, command=("ls", "-l"))) == ["ls", "-l"]
    assert command_of(PlannedNode("/a", "", HERE, HERE, command=("graphflow", "ps")))[3:] == ["graphflow", "ps"]


def pids_of(machine: Machine) -> list[int]:
    return [row["pid"] for row in rows(machine).values()]


def log_of(machine: Machine) -> Path:
    return Path(rows(machine)["/p"]["log"])


@slow
def test_a_program_is_like_a_node(machine: Machine, project: Path) -> None:
    """Its output is logged, it has its environment and the usual signals, it is asked to end; so is what it started."""
    machine.run("up", "-d", write(project, SHELL), cwd=project)
    pids, log = pids_of(machine), log_of(machine)
    machine.until(lambda: "red here" in log.read_text(), "it has begun")
    children = [child.pid for child in psutil.Process(rows(machine)["/p"]["pid"]).children()]
    assert rows(machine)["/p"]["class"].startswith("sh -c")
    assert "/p is running again, process" in machine.look("restart", "/p")
    machine.look("down")
    nothing_is_left(machine, [*pids, *children])
    assert log.read_text().count("cleaned up") == (0 if is_portable() and os.name == "nt" else 2)


@slow
@pytest.mark.skipif(is_portable(), reason="the portable way has no guardian")
@pytest.mark.parametrize("victim", some(["supervisor", "preload"], "preload"))
def test_it_ends_with_the_graph(machine: Machine, project: Path, victim: str) -> None:
    """Whichever of the graph's processes is killed, it is asked to end, and has."""
    machine.run("up", "-d", write(project, SHELL), cwd=project)
    pids, log = pids_of(machine), log_of(machine)
    machine.until(lambda: "red here" in log.read_text(), "it has begun")
    supervisor = psutil.Process(supervisor_of(machine)["pid"])
    [preload] = supervisor.children()
    os.kill(supervisor.pid if victim == "supervisor" else preload.pid, signal.SIGKILL)
    nothing_is_left(machine, pids)
    assert "cleaned up" in log.read_text()


RESTARTS = """\
nodes:
  /a: {class: nodes.lab:Good, restart: on_failure}
  /p: {command: [sleep, "600"], restart: {policy: always, delay: 0.05}}
"""


@slow
def test_killed_processes_are_started_again(machine: Machine, project: Path) -> None:
    """With a new process, and what was is known; `down` ends the new ones."""
    machine.run("up", "-d", write(project, RESTARTS), cwd=project)
    before = {name: row["pid"] for name, row in rows(machine).items()}
    for pid in before.values():
        os.kill(pid, signal.SIGKILL)
    machine.until(lambda: {row["restarts"] for row in rows(machine).values()} == {1}, "both are started again")
    machine.until(lambda: {row["state"] for row in rows(machine).values()} == {"ready"}, "both are ready")
    after = rows(machine)
    assert all(after[name]["pid"] != pid and not alive(pid) for name, pid in before.items())
    assert "restarted: once" in machine.look("status", "/a")
    assert "last end: signal SIGKILL" in machine.look("status", "/a")
    machine.look("down")
    nothing_is_left(machine, [row["pid"] for row in after.values()])


LAMP = """\
import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32


def main():
    rclpy.init()
    node = Node("lamp")
    level = node.declare_parameter("level", 1).value
    publisher = node.create_publisher(Int32, "light", 10)
    node.create_timer(0.1, lambda: publisher.publish(Int32(data=level)))
    node.get_logger().info(f"level {level}")
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        print("the light goes out", flush=True)
"""
LAMPS = """\
group:
  namespace: room
  params: {level: 3}
  nodes:
    big: {pkg: lamp, exec: lamp, remap: {light: /sun}, restart: {policy: always, delay: 0.05}}
    as_coded: {pkg: lamp, exec: lamp, keep_names: true}
"""


LAUNCHED = """\
from launch import LaunchDescription
from launch_ros.actions import Node, PushRosNamespace, SetParameter


def generate_launch_description():
    big = Node(package="lamp", executable="lamp", name="big", remappings=[("light", "/sun")], respawn=True)
    as_coded = Node(package="lamp", executable="lamp")
    return LaunchDescription([PushRosNamespace("room"), SetParameter("level", 3), big, as_coded])
"""


@slow
@pytest.mark.parametrize("start", some(["graph file", "launch file"], "graph file"))
def test_an_executable_of_a_package_is_a_node(machine: Machine, project: Path, start: str) -> None:
    """It has its name, namespace, remaps and parameters, is logged, asked for parameters, and started again."""
    package = project / "src" / "lamp"
    (package / "lamp").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>lamp</name></package>")
    (package / "setup.py").write_text("setup(entry_points={'console_scripts': ['lamp = lamp.node:main']})")
    (package / "lamp" / "node.py").write_text(LAMP)
    (project / "lamps.launch.py").write_text(LAUNCHED)
    machine.run("up", "-d", write(project, LAMPS) if start == "graph file" else "lamps.launch.py", cwd=project)
    both = ["/room/big", "/room/lamp"]
    machine.until(lambda: machine.look("node", "list").split() == both, "both are there")
    assert "data: 3" in machine.look("topic", "echo", "/sun", "std_msgs/msg/Int32", "--once")
    level = ("param", "get", "/room/lamp", "level")  # which it declares after it has been seen
    machine.until(lambda: machine.look(*level, code=None) == "Integer value is: 3\n", "it has its parameters")
    assert "[room.lamp]: level 3" in machine.look("logs", next(n for n in rows(machine) if n != "/room/big"))
    pid = rows(machine)["/room/big"]["pid"]
    os.kill(pid, signal.SIGKILL)
    machine.until(lambda: rows(machine)["/room/big"]["restarts"] == 1, "it is started again")
    assert "data: 3" in machine.look("topic", "echo", "/sun", "std_msgs/msg/Int32", "--once")
    pids, log = pids_of(machine), Path(rows(machine)["/room/big"]["log"])
    machine.look("down")
    nothing_is_left(machine, pids)
    assert os.name == "nt" or log.read_text().count("the light goes out") == 1  # the other one was killed


@slow
def test_a_program_that_cannot_be_started(machine: Machine, project: Path) -> None:
    """It is a mistake in the file, found before anything is started."""
    text = machine.run("up", write(project, "nodes: {/p: {command: [no-such-program]}}"), cwd=project, code=2)
    assert "the program 'no-such-program' cannot be started: it is not on the PATH" in text
