"""Data keys, `<domain>/<name>/<type>/<hash>`, and the DDS form of type names inside them.

Source: rmw_zenoh design document, "Topic and Service name mapping to Zenoh key expressions".
"""

from __future__ import annotations

from typing import NamedTuple


def dds_type(type_name: str) -> str:
    """Convert `std_msgs/msg/String` to `std_msgs::msg::dds_::String_`."""
    package, kind, name = type_name.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def ros_type(dds_name: str) -> str:
    """Convert `std_msgs::msg::dds_::String_` to `std_msgs/msg/String`; return anything else unchanged."""
    head, marker, tail = dds_name.partition("dds_::")
    if not marker or not tail.endswith("_"):
        return dds_name
    return head.replace("::", "/") + tail[:-1]


class DataKey(NamedTuple):
    """The parts of a data key; `name` is the full ROS name with its leading slash."""

    domain: int
    name: str
    type: str
    hash: str

    def __str__(self) -> str:
        return f"{self.domain}/{self.name[1:]}/{dds_type(self.type)}/{self.hash}"


def parse_data_key(key: str) -> DataKey | None:
    """Parse a data key; None if it is not one."""
    parts = key.split("/")
    if len(parts) < 4 or not parts[0].isdecimal():
        return None
    return DataKey(int(parts[0]), "/" + "/".join(parts[1:-2]), ros_type(parts[-2]), parts[-1])
