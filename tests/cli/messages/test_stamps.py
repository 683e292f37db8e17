"""Times that are filled in when a message is sent."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.cli.messages.stamps import split_stamps, stamp
from graphflow.msgs.geometry_msgs.msg import PoseStamped

POSE = "geometry_msgs/msg/PoseStamped"


@pytest.mark.parametrize(
    ("type_name", "values", "kept", "paths"),
    [
        (POSE, {"header": "auto", "pose": {}}, {"pose": {}}, [("header", "stamp")]),
        (POSE, {"header": {"stamp": "now", "frame_id": "map"}}, {"header": {"frame_id": "map"}}, [("header", "stamp")]),
        ("builtin_interfaces/msg/Time", {"sec": 5}, {"sec": 5}, []),
        ("std_msgs/msg/String", {"data": "now"}, {"data": "now"}, []),
        ("std_msgs/msg/String", {"header": "auto"}, {"header": "auto"}, []),
        ("rcl_interfaces/msg/Log", {"stamp": "now"}, {}, [("stamp",)]),
        (POSE, None, None, []),
        (POSE, {"pose": "auto"}, {"pose": "auto"}, []),
        ("nav_msgs/msg/Path", {"poses": [{"header": "auto"}]}, {"poses": [{"header": "auto"}]}, []),
    ],
)
def test_words_for_times(type_name: str, values: Any, kept: Any, paths: list[tuple[str, ...]]) -> None:
    """Only where the field is a header or a time; elsewhere they are values, and may be wrong ones."""
    assert split_stamps(type_name, values) == (kept, paths)


def test_stamping() -> None:
    """Seconds and nanoseconds."""
    message = PoseStamped()
    stamp(message, [("header", "stamp")], 5_000_000_007)
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (5, 7)
