"""Which topics are meant."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.bag.topic_choice import Choice

STRING = "std_msgs/msg/String"


@pytest.mark.parametrize(
    ("options", "name", "wanted"),
    [
        ({}, "/a", False),
        ({"all": True}, "/a", True),
        ({"all": True}, "/_a", False),
        ({"all": True}, "/room/_a/b", False),
        ({"all": True, "hidden": True}, "/_a", True),
        ({"all": True, "exclude": frozenset({"/a"})}, "/a", False),
        ({"all": True, "exclude_regex": "a$"}, "/a", False),
        ({"all": True, "exclude_regex": "a$"}, "/ab", True),
        ({"all": True, "exclude_types": frozenset({STRING})}, "/a", False),
        ({"topics": frozenset({"/a"})}, "/a", True),
        ({"topics": frozenset({"/a"})}, "/b", False),
        ({"topics": frozenset({"/_a"})}, "/_a", True),
        ({"topics": frozenset({"/a"}), "exclude_regex": "a"}, "/a", True),
        ({"topics": frozenset({"/a"}), "exclude": frozenset({"/a"})}, "/a", False),
        ({"regex": "camera|lidar"}, "/left/camera/image", True),
        ({"regex": "camera|lidar"}, "/odom", False),
        ({"types": frozenset({STRING})}, "/a", True),
        ({"types": frozenset({"std_msgs/msg/Int32"})}, "/a", False),
        ({"all": True, "hidden": True}, "/add/_service_event", False),
        ({"all_services": True}, "/add/_service_event", True),
        ({"all_services": True, "exclude_services": frozenset({"/add"})}, "/add/_service_event", False),
        ({"all_services": True}, "/_hidden/add/_service_event", False),
        ({"services": frozenset({"/add"})}, "/add/_service_event", True),
        ({"services": frozenset({"/add"})}, "/add", False),
    ],
)
def test_wants(options: dict[str, Any], name: str, wanted: bool) -> None:
    """By name, type and pattern, less what is excluded; hidden ones and services only when they are asked for."""
    assert Choice(**options).wants(name, STRING) is wanted
