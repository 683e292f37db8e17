"""Every graph file of the project, run for real."""

from __future__ import annotations

import json
import math
from typing import Any
from xml.etree import ElementTree

import pytest

from tests.cases import slow
from tests.conftest import PROJECT, Machine

pytestmark = pytest.mark.real


def pose(machine: Machine, turtle: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(machine.look("topic", "echo", f"/{turtle}/pose", "--once", "--json"))
    return found


def picture(machine: Machine) -> ElementTree.Element:
    answer = json.loads(machine.look("service", "call", "/turtlesim/snapshot", "std_srvs/srv/Trigger", "--json"))
    assert answer["success"]
    return ElementTree.fromstring(answer["message"])


@slow
def test_every_graph_file_checks_out(machine: Machine) -> None:
    """No file in graphs/ has a mistake."""
    files = sorted(p.name for p in (PROJECT / "graphs").glob("*.yaml"))
    assert {"draw_circle.yaml", "talker_listener.yaml", "turtlesim.yaml"} <= set(files)
    for file in files:
        assert "no problems" in machine.look("check", f"graphs/{file}")


def test_talker_listener(machine: Machine) -> None:
    """The argument reaches the parameter, and one hears the other."""
    up = machine.start("up", "graphs/talker_listener.yaml", "rate:=25.0")
    up.wait_for("I heard: [Hello World: 5")  # or 50, where the listener came late
    assert machine.look("param", "get", "/talker", "rate") == "Double value is: 25.0\n"
    assert up.end() == 0


@slow
def test_draw_circle(machine: Machine) -> None:
    """The turtle keeps to a circle of radius v / w through its starting point."""
    machine.run("up", "-d", "graphs/draw_circle.yaml", "linear:=3.0", "angular:=2.0")
    machine.until(lambda: pose(machine, "turtle1")["linear_velocity"] == 3.0, "it drives")
    for _ in range(5):
        at = pose(machine, "turtle1")
        radius = math.hypot(at["x"] - 5.544445, at["y"] - (5.544445 + 1.5))
        assert radius == pytest.approx(1.5, abs=0.05)
    machine.look("down")


def test_turtlesim(machine: Machine) -> None:
    """Leader and follower move; parameters and services of the simulator answer, and misspelt words are corrected."""
    machine.run("up", "-d", "graphs/turtlesim.yaml", "follower:=donatello")
    assert "/donatello/chaser" in machine.look("node", "list")
    machine.until(lambda: pose(machine, "donatello")["linear_velocity"] > 0, "the follower drives")
    machine.until(lambda: pose(machine, "turtle1")["linear_velocity"] > 0, "the leader drives")

    assert picture(machine).find(".//*[@fill='#1e3c72']") is not None
    assert machine.look("param", "set", "/turtlesim", "background_r", "200") == "Set parameter successful\n"
    assert picture(machine).find(".//*[@fill='#c83c72']") is not None
    refused = machine.look("param", "set", "/turtlesim", "background_r", "300", code=1)
    assert "out of range: 0 to 255" in refused
    assert machine.look("param", "get", "/turtlesim", "background_r") == "Integer value is: 200\n"
    assert "did you mean '/turtlesim'?" in machine.look("param", "get", "/turtelsim", "background_r", code=1)
    assert "did you mean 'background_r'?" in machine.look("param", "get", "/turtlesim", "backgroundr", code=1)

    assert "/spawn is of type turtlesim/srv/Spawn" in machine.look("service", "call", "/spawn", code=2)
    assert "did you mean '/spawn'?" in machine.look("service", "call", "/spwan", code=1)
    spawned = machine.look(
        "service", "call", "/spawn", "turtlesim_msgs/srv/Spawn", "{x: 2, y: 2, theta: 0.2, name: ''}"
    )
    assert "turtlesim/srv/Spawn; using that" in spawned
    assert "turtlesim.srv.Spawn_Response(name='turtle2')" in spawned
    machine.look("down")


@slow
def test_the_unquoted_command_of_the_slides(machine: Machine) -> None:
    """What the shell splits into many words is put together again: the turtle draws its circle."""
    machine.start("run", "nodes.turtlesim:TurtleSim").wait_for("Spawning turtle [turtle1]")
    slide = (
        "topic pub -r 10 /turtle1/cmd_vel geometry_msgs/msg/Twist "
        "{linear: {x: 2.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}"
    )
    pub = machine.start(*slide.split())
    pub.wait_for(
        "publishing #3: geometry_msgs.msg.Twist(linear=geometry_msgs.msg.Vector3(x=2.0, y=0.0, z=0.0), "
        "angular=geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=1.8))"
    )
    machine.until(lambda: pose(machine, "turtle1")["angular_velocity"] == pytest.approx(1.8), "it turns")
    assert pub.end() == 0


@slow
def test_via_points(machine: Machine) -> None:
    """The scheduler sends the follower on, over services of the project's own."""
    up = machine.start("up", "graphs/via_points.yaml")
    up.wait_for("next: (5, 9)", limit=40.0)
    assert "arrived at (2, 1)" in up.text
    assert up.end() == 0


@slow
def test_ten_turtles(machine: Machine) -> None:
    """As many as the argument says."""
    machine.run("up", "-d", "graphs/ten_turtles.yaml", "count:=3")
    machine.until(lambda: pose(machine, "turtle4")["linear_velocity"] == 1.0, "the third drives")
    assert "/turtle5/pose" not in machine.look("topic", "list")
    machine.look("down")
