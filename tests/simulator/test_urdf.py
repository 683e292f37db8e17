"""Descriptions of simulated robots."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.description import parse
from graphflow.simulator.files import bundled, find, read_robot
from graphflow.simulator.urdf import described


@pytest.mark.parametrize("name", bundled("robots"))
def test_bundled_robots(name: str) -> None:
    """Each is a valid description whose sensors and wheels are where the simulator has them."""
    model = read_robot(find(name, "robots", Path()))
    robot = parse(described(model, "two/"))
    assert robot.name == name
    assert robot.root == f"two/{model.footprint_frame}"
    wheel = robot.joints["wheel_left_joint"]
    assert wheel.parent == f"two/{model.base_frame}"
    height = model.base_height
    assert wheel.origin.translation == pytest.approx((0.0, model.wheels.separation / 2, model.wheels.radius - height))
    assert model.lidar is not None
    scan = robot.joints["scan_joint"].origin.translation
    assert scan == pytest.approx((model.lidar.at[0], model.lidar.at[1], model.lidar.at[2] - height))
    assert all(link.visuals for name, link in robot.links.items() if "footprint" not in name and "imu" not in name)
