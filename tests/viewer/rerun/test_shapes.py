"""Robots' links in Rerun."""

from __future__ import annotations

import pytest

rr = pytest.importorskip("rerun", reason="the extra `rerun` is not installed")

from pathlib import Path

from graphflow.description import parse
from graphflow.msgs.std_msgs.msg import String
from graphflow.viewer.rerun.archetypes import shown
from graphflow.viewer.rerun.shapes import robot_shapes


def test_descriptions() -> None:
    """A robot's shapes are in the frames of its links."""
    visual = '<visual><geometry><box size="1 2 3"/></geometry></visual>'
    text = f'<robot name="r"><link name="base">{visual}{visual.replace("box size", "sphere radius")}</link></robot>'
    text = text.replace('radius="1 2 3"', 'radius="1"')
    found = list(shown("/robot_description", "std_msgs/msg/String", String(data=text)))
    assert [(path, frame) for path, frame, _ in found] == [("robot/r/base/0", "base"), ("robot/r/base/1", "base")]
    [(path, _, _)] = shown("/robot_description", "std_msgs/msg/String", String(data="<sdf/>"))
    assert path == "log/not_shown"


def test_meshes(tmp_path: Path) -> None:
    """A mesh that is found is shown at its place; one that is not is left out."""
    (tmp_path / "m.stl").touch()
    visuals = "".join(
        f'<visual><origin xyz="0 0 1"/><geometry><mesh filename="{name}"/></geometry></visual>'
        for name in ("m.stl", "no.stl")
    )
    robot = parse(f'<robot name="r"><link name="base">{visuals}</link></robot>')
    found = list(robot_shapes(robot, tmp_path))
    assert [type(archetype) for _, _, archetype in found] == [rr.Asset3D, rr.InstancePoses3D]
