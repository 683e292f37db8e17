"""Worlds as MJCF."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from graphflow.simulator.files import find, read_robot
from graphflow.simulator.mjcf import model, mover_name
from graphflow.simulator.world import World


def test_everything_is_there() -> None:
    """Walls have a box for each side; what has a mass is a body of its own."""
    world = World.model_validate(
        {
            "walls": [{"points": [[0, 0], [1, 0], [1, 1]], "closed": True}],
            "boxes": [{"at": [2, 0], "size": [1, 1, 1]}, {"at": [4, 0], "size": [1, 1, 1], "mass": 2.0}],
            "moving": [{"path": [[0, 5], [1, 5]], "speed": 1.0}],
            "robots": [{"name": "a"}],
        }
    )
    root = ElementTree.fromstring(model(world, [(world.robots[0], read_robot(find("burger", "robots", Path())))]))
    bodies = {body.get("name") for body in root.iter("body")}
    assert bodies == {"box1", mover_name(0), "a/base", "a/left_wheel", "a/right_wheel"}
    fixed = root.findall("worldbody/geom")
    assert [geom.get("type") for geom in fixed] == ["plane", "box", "box", "box", "box"]
    assert {motor.get("joint") for motor in root.iter("velocity")} == {"a/left", "a/right"}
