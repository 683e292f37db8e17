"""Descriptions of robots."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from graphflow.simulator.robot import Lidar, Wheels


def test_numbers_are_checked() -> None:
    """No wheel has a negative radius, and no scanner an endless range."""
    with pytest.raises(ValidationError, match="radius"):
        Wheels(radius=-1.0, separation=0.1, mass=0.1, torque=0.1)
    with pytest.raises(ValidationError, match="range_max"):
        Lidar(at=[0, 0, 0], beams=1, range_min=0.1, range_max=float("inf"), rate=1.0)
