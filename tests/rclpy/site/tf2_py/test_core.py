"""The buffer, by messages."""

from __future__ import annotations

from typing import Any

import pytest
import yaml
from geometry_msgs.msg import TransformStamped
from tf2_py import BufferCore, InvalidArgumentException, LookupException
from tf2_py.core import message, nanoseconds

from graphflow.tf.poses import IDENTITY, Pose
from rclpy.duration import Duration
from rclpy.time import Time

S = 10**9


def transform(parent: str, frame: str, second: int = 0, x: float = 1.0) -> TransformStamped:
    return message(Pose((x, 2.0, 3.0), (0.0, 0.0, 1.0, 0.0)), parent, frame, second * S)


def test_transforms_come_and_go_as_messages() -> None:
    """With the frames that were asked for; times are rclpy's or a message's."""
    core = BufferCore()
    core.set_transform(transform("odom", "base", 5), "me")
    core.set_transform_static(transform("base", "/laser"))
    found = core.lookup_transform_core("odom", "base", Time())
    assert (found.header.frame_id, found.child_frame_id, nanoseconds(found.header.stamp)) == ("odom", "base", 5 * S)
    assert found.transform == transform("odom", "base").transform
    assert core.lookup_transform_core("odom", "base", found.header.stamp) == found
    assert core.can_transform_core("odom", "laser", Time(seconds=5)) == (True, "")
    can, why = core.can_transform_core("odom", "laser", Time(seconds=6))
    assert not can
    assert "extrapolation" in why or "only time" in why
    assert core.get_latest_common_time("odom", "laser") == Time(seconds=5)
    assert core._frameExists("odom")
    assert core._getFrameStrings() == ["base", "laser", "odom"]
    assert core.all_frames_as_string().splitlines()[0] == "Frame base exists with parent odom."
    frames = yaml.safe_load(core.all_frames_as_yaml())
    assert frames["base"]["parent"] == "odom"
    assert frames["base"]["broadcaster"] == "me"
    core.clear()
    assert core._getFrameStrings() == ["base", "laser"]


def test_between_two_times() -> None:
    """By a frame that has not moved meanwhile."""
    core = BufferCore(Duration(seconds=100))
    for second in (1, 51):
        core.set_transform(message(Pose((float(second), 0.0, 0.0), IDENTITY.rotation), "odom", "base", second * S))
    asked: tuple[Any, ...] = ("base", Time(seconds=51), "base", Time(seconds=1), "odom")
    assert core.lookup_transform_full_core(*asked).transform.translation.x == -50
    assert core.can_transform_full_core(*asked) == (True, "")
    assert not core.can_transform_full_core(*(*asked[:-1], "nothing"))[0]


@pytest.mark.parametrize(
    ("parent", "frame", "numbers", "said"),
    [
        ("", "base", (0.0, 0.0, 0.0, 1.0), "must not be empty"),
        ("base", "/base", (0.0, 0.0, 0.0, 1.0), "are both 'base'"),
        ("odom", "base", (0.0, 0.0, 0.0, 0.0), "the quaternion of 'base' is not normalized"),
        ("odom", "base", (0.0, 0.0, 0.0, float("nan")), "a number of 'base' is infinite or not a number"),
        ("odom", "b" * 2000, (0.0, 0.0, 0.0, 1.0), "longer than 1000 characters"),
    ],
)
def test_what_makes_no_sense_is_left_out_and_told(
    parent: str, frame: str, numbers: Any, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """It must not spoil what is known."""
    core = BufferCore()
    core.set_transform(message(Pose((0.0, 0.0, 0.0), numbers), parent, frame, S), "somebody")
    assert core._getFrameStrings() == []
    assert said in capsys.readouterr().err


def test_names_that_are_asked_for_are_checked() -> None:
    """As in tf2: no slash before them."""
    core = BufferCore()
    core.set_transform(transform("odom", "base"))
    with pytest.raises(InvalidArgumentException, match="cannot start with a '/'"):
        core.lookup_transform_core("/odom", "base", Time())
    with pytest.raises(InvalidArgumentException, match="cannot be empty"):
        core.lookup_transform_core("odom", "", Time())
    assert core.lookup_transform_core("moon", "moon", Time()).transform.rotation.w == 1.0  # whatever that is
    assert core.can_transform_core("", "", Time()) == (True, "")
    with pytest.raises(LookupException):
        core.lookup_transform_core("odom", "bsae", Time())
