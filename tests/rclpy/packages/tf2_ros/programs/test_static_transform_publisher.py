"""What the command line of static_transform_publisher means, and that it is published."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from tf2_ros import Buffer, TransformListener

import rclpy
from rclpy.node import Node
from rclpy.time import Time

FRAMES = ["--frame-id", "map", "--child-frame-id", "base"]


@pytest.mark.parametrize(
    ("words", "translation", "rotation"),
    [
        ([], (0, 0, 0), (0, 0, 0, 1)),
        (["--x", "-1e-3", "--z", "-.5"], (-0.001, 0, -0.5), (0, 0, 0, 1)),
        (["--x=2", "--yaw", str(math.pi / 2)], (2, 0, 0), (0, 0, math.sqrt(0.5), math.sqrt(0.5))),
        (["--roll", str(math.pi)], (0, 0, 0), (1, 0, 0, 0)),
        (["--qz", "1", "--qw", "0"], (0, 0, 0), (0, 0, 1, 0)),
        (["--qx", "0"], (0, 0, 0), (0, 0, 0, 1)),
    ],
)
def test_options(
    program: Callable[[str], Any], words: list[str], translation: tuple[float, ...], rotation: tuple[float, ...]
) -> None:
    """What is not said is 0; numbers may be negative, and have exponents."""
    pose, parent, child = program("tf2_ros/static_transform_publisher")["parsed"]([*words, *FRAMES])
    assert (parent, child) == ("map", "base")
    assert pose.translation == pytest.approx(translation)
    assert pose.rotation == pytest.approx(rotation)


def test_the_old_way(program: Callable[[str], Any], capfd: pytest.CaptureFixture[str]) -> None:
    """By place: x y z, then yaw pitch roll or a quaternion; it is warned of."""
    parsed = program("tf2_ros/static_transform_publisher")["parsed"]
    pose, parent, child = parsed(["1", "-2", "3", str(math.pi), "0", "0", "map", "odom"])
    assert (parent, child, pose.translation) == ("map", "odom", (1, -2, 3))
    assert pose.rotation == pytest.approx((0, 0, 1, 0), abs=1e-9)
    assert parsed(["1", "-2", "3", "0", "1", "0", "0", "map", "odom"])[0].rotation == (0, 1, 0, 0)
    assert "Old-style arguments are deprecated" in capfd.readouterr().err


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--frame-id", "map"], "--frame-id and --child-frame-id are required"),
        ([*FRAMES, "--yaw", "1", "--qw", "1"], "but not both"),
        ([*FRAMES, "--x", "one"], "argument --x: 'one' is not a finite number"),
        ([*FRAMES, "--yaw", "inf"], "argument --yaw: 'inf' is not a finite number"),
        ([*FRAMES, "--x"], "argument --x: expected one argument"),
    ],
)
def test_mistakes(
    program: Callable[[str], Any], words: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """They end it with 2, and are told."""
    with pytest.raises(SystemExit) as ended:
        program("tf2_ros/static_transform_publisher")["parsed"](words)
    assert ended.value.code == 2
    assert told in capsys.readouterr().err


def test_it_is_published_for_those_who_come_later(program: Callable[[str], Any], node: Node, spin: Any) -> None:
    """With a quaternion of length 1; its parameters tell it, and cannot be changed."""
    loaded = program("tf2_ros/static_transform_publisher")
    publisher = loaded["StaticTransformPublisher"](loaded["parsed"]([*FRAMES, "--x", "4", "--qw", "2"])[0], "a", "b")
    buffer = Buffer()
    TransformListener(buffer, node)
    spin(lambda: buffer.can_transform("a", "b", Time()))
    found = buffer.lookup_transform("a", "b", Time()).transform
    assert (found.translation.x, found.rotation.w) == (4.0, 1.0)
    assert publisher.get_parameter("translation.x").value == 4.0
    [result] = publisher.set_parameters([rclpy.Parameter("frame_id", value="c")])
    assert not result.successful
    with pytest.raises(ValueError, match="from 'a' to 'a'"):
        loaded["StaticTransformPublisher"](loaded["parsed"](FRAMES)[0], "a", "a")
