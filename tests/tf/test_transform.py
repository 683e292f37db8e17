"""Transforms as values: chained, inverted, and applied to arrays."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest

from graphflow import DeclarationError, Time
from graphflow.tf import Transform

LEFT = Transform.of("base", "laser", (1.0, 0.0, 0.0), rpy=(0.0, 0.0, math.pi / 2))


def test_numbers() -> None:
    """A transform can be read as angles, as a quaternion, and as a matrix."""
    assert LEFT.yaw == pytest.approx(math.pi / 2)
    assert LEFT.rpy == pytest.approx((0.0, 0.0, math.pi / 2))
    assert LEFT.rotation == pytest.approx((0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
    assert np.allclose(LEFT.matrix(), [[0, -1, 0, 1], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    assert Transform.of("a", "b", rotation=(0.0, 0.0, 1.0, 0.0)).yaw == pytest.approx(math.pi)


def test_as_a_message() -> None:
    """Nothing is lost on the way to a message and back."""
    transform = Transform.of("map", "odom", (1.0, 2.0, 3.0), rpy=(0.1, 0.2, 0.3), stamp=Time(1_500_000_000))
    message = transform.to_msg()
    assert (message.header.frame_id, message.child_frame_id) == ("map", "odom")
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (1, 500_000_000)
    assert Transform.from_msg(message) == transform


def test_chains() -> None:
    """Two transforms join where the child of one is the parent of the other."""
    there = Transform.of("odom", "base", (0.0, 5.0, 0.0), stamp=Time(7)) @ LEFT
    assert (there.parent, there.child, there.stamp) == ("odom", "laser", Time(7))
    assert there.translation == pytest.approx((1.0, 5.0, 0.0))
    back = there.inverse()
    assert (back.parent, back.child) == ("laser", "odom")
    assert np.allclose(back.matrix() @ there.matrix(), np.eye(4))
    with pytest.raises(ValueError, match="base -> laser and odom -> base do not join: 'laser' is not 'odom'"):
        LEFT @ Transform.of("odom", "base")


def test_arrays() -> None:
    """Points are moved and turned, vectors turned only; the shape stays."""
    points = LEFT.points([[2.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    assert np.allclose(points, [[1.0, 2.0, 0.0], [1.0, 0.0, 1.0]])
    assert np.allclose(LEFT.vectors([2.0, 0.0, 0.0]), [0.0, 2.0, 0.0])
    assert LEFT.points(np.zeros((4, 5, 3))).shape == (4, 5, 3)


@pytest.mark.parametrize(
    ("numbers", "told"),
    [
        ({"translation": (1.0, 2.0)}, r"the translation is three numbers, (x, y, z), and not (1.0, 2.0)"),
        ({"translation": 1.0}, "the translation is three numbers"),
        ({"rpy": 1.5}, "rpy is three numbers, (0.0, 0.0, yaw), and not 1.5"),
        ({"rpy": ("a", 0, 0)}, "rpy is three numbers"),
    ],
)
def test_other_than_three_numbers(numbers: Any, told: str) -> None:
    """Are refused."""
    with pytest.raises(DeclarationError, match=re.escape(told)):
        Transform.of("a", "b", **numbers)
