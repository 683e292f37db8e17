"""`graphflow tf`, between processes."""

from __future__ import annotations

import json
import re

import pytest

from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real


@slow
def test_static_transforms(machine: Machine) -> None:
    """One process publishes a transform, and others show it."""
    static = machine.start("tf", "static", "map", "odom", "--x", "1", "--y", "-2", "--yaw", "1.5708")
    static.wait_for("odom is in map at (1, -2, 0) until Ctrl-C")
    assert machine.look("tf", "tree", "-t", "0.5").startswith("map\n└── odom   (static, by /static_transform_publish")
    shown = machine.look("tf", "echo", "map", "odom", "--once")
    assert "- Translation: [1.000, -2.000, 0.000]" in shown
    assert json.loads(machine.look("tf", "echo", "odom", "map", "-1", "--json"))["translation"] == pytest.approx(
        [2, 1, 0], abs=1e-4
    )
    assert json.loads(machine.look("tf", "tree", "-t", "0.5", "--json"))[0]["parent"] == "map"
    assert static.end() == 0


@slow
def test_the_tutorial(machine: Machine) -> None:
    """The turtles' frames have rates and publishers; what cannot be looked up is explained."""
    machine.run("up", "-d", "graphs/turtle_tf2.yaml")
    tree = machine.look("tf", "tree")
    assert re.match(r"world\n├── turtle1   \([\d.]+ Hz, [\d.]+ s old, by /turtle1/broadcaster\)\n", tree)
    assert re.search(r"│   └── carrot1   \([\d.]+ Hz, ", tree)
    assert "by /turtle2/broadcaster)" in tree
    summary = machine.look("tf", "monitor", "turtle2", "carrot1", "--once")
    assert "Chain is: turtle2 -> world -> turtle1 -> carrot1\nNet delay     avg = " in summary
    assert "RESULTS: for all Frames" in machine.look("tf", "monitor", "-1")
    told = machine.look("tf", "echo", "turtle2", "carot1", "--once", code=4)
    assert "there is no frame 'carot1'; did you mean 'carrot1'?" in told


def test_mistakes(machine: Machine) -> None:
    """Each is answered with what to write, or with what is missing."""
    for words, code, text in (
        (("static", "map"), 2, "tf static takes two frames: graphflow tf static map odom --x 1 --yaw 1.57"),
        (("static", "map", "odom", "--qx", "1"), 2, "give all of --qx --qy --qz --qw, or the angles"),
        (("static", "map", "map"), 1, "the transform map -> map is not sent: frame_id and child_frame_id are both"),
        (("monitor", "map"), 2, "tf monitor takes two frames, or none"),
        (("tree", "-t", "0.1"), 0, "no transforms in 0.1 s"),
        (("tre",), 2, "no such command 'tre'; did you mean 'tree'?"),
    ):
        assert text in machine.look("tf", *words, code=code), words
