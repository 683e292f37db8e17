"""Poses in the plane."""

from __future__ import annotations

import math

import pytest

from graphflow.tf import Pose2D, Transform


def test_poses() -> None:
    """A pose and its inverse cancel."""
    pose = Pose2D(1.0, -2.0, 2.5)
    back = pose.of(pose.inverse())
    assert (back.x, back.y, back.yaw) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_chains() -> None:
    """They are those of three dimensions, on a floor; a yaw stays between -pi and pi."""
    first, second = Pose2D(1.0, 2.0, 3.0), Pose2D(-0.5, 0.25, 1.0)
    chained = first.of(second)
    outer = Transform.of("a", "b", (first.x, first.y, 0.0), rpy=(0.0, 0.0, first.yaw))
    inner = Transform.of("b", "c", (second.x, second.y, 0.0), rpy=(0.0, 0.0, second.yaw))
    found = (outer @ inner).planar
    assert (chained.x, chained.y, chained.yaw) == pytest.approx((found.x, found.y, found.yaw))
    assert chained.yaw == pytest.approx(4.0 - math.tau)
