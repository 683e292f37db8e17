"""Choosing a wire profile on the command line."""

from __future__ import annotations

import pytest

from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real


@slow
def test_a_profile_chooses_definitions(machine: Machine) -> None:
    """By option or variable, the option first."""
    event = ("interface", "show", "lifecycle_msgs/msg/TransitionEvent")
    assert "uint64 timestamp" in machine.run(*event)
    assert "Time stamp" in machine.run("--wire", "lyrical", *event)
    machine.env["GRAPHFLOW_WIRE"] = "lyrical"
    assert "Time stamp" in machine.run(*event)
    assert "uint64 timestamp" in machine.run("--wire", "kilted", *event)
    machine.env["GRAPHFLOW_WIRE"] = "lyrica"
    assert "'lyrica' is not a wire profile; did you mean 'lyrical'?" in machine.run(*event, code=2)


@slow
def test_peers_of_another_profile_are_told_apart(machine: Machine) -> None:
    """A graph on Kilted's wire has Kilted's types; a node on Jazzy's reports the difference and the remedy."""
    machine.run("up", "-d", "turtlesim", "--wire", "kilted")
    assert "/turtle1/pose [turtlesim_msgs/msg/Pose]" in machine.run("topic", "list", "-t")
    words = ("nodes.turtle_follower:TurtleFollower", "__ns:=/turtle1", "__node:=other", "goal:=/turtle2/pose")
    node = machine.start("run", *words)
    node.wait_for("nothing passes between the publisher of /turtlesim, of type turtlesim_msgs/msg/Pose")
    node.wait_for("start with --wire kilted")
    node.end()
    kilted = machine.start("--wire", "kilted", "run", *words)
    machine.until(lambda: "/turtle1/other" in machine.run("node", "list"), "the other node is up")
    kilted.end()
    assert "WARN" not in kilted.text
    machine.run("down")
