"""Data keys and type names."""

from __future__ import annotations

import pytest

from graphflow.wire.keyexpr import DataKey, dds_type, parse_data_key, ros_type

STRING = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
JOINTS = "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"
ADD = "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"
SEND = "RIHS01_d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557"

KEYS = [
    (DataKey(0, "/chatter", "std_msgs/msg/String", STRING), f"0/chatter/std_msgs::msg::dds_::String_/{STRING}"),
    (
        DataKey(0, "/robot1/arm/state", "sensor_msgs/msg/JointState", JOINTS),
        f"0/robot1/arm/state/sensor_msgs::msg::dds_::JointState_/{JOINTS}",
    ),
    (
        DataKey(2, "/add_two_ints", "example_interfaces/srv/AddTwoInts", ADD),
        f"2/add_two_ints/example_interfaces::srv::dds_::AddTwoInts_/{ADD}",
    ),
    (
        DataKey(0, "/fibonacci/_action/send_goal", "example_interfaces/action/Fibonacci_SendGoal", SEND),
        f"0/fibonacci/_action/send_goal/example_interfaces::action::dds_::Fibonacci_SendGoal_/{SEND}",
    ),
]
TYPES = [
    ("pkg/msg/Name", "pkg::msg::dds_::Name_"),
    ("pkg/srv/Name", "pkg::srv::dds_::Name_"),
    ("pkg/srv/Name_Event", "pkg::srv::dds_::Name_Event_"),
    ("pkg/action/Name_GetResult", "pkg::action::dds_::Name_GetResult_"),
    ("pkg/action/Name_FeedbackMessage", "pkg::action::dds_::Name_FeedbackMessage_"),
    ("action_msgs/srv/CancelGoal", "action_msgs::srv::dds_::CancelGoal_"),
]


@pytest.mark.parametrize(("parts", "key"), KEYS)
def test_data_key_is_written(parts: DataKey, key: str) -> None:
    """A data key joins domain, name, DDS type and hash, the name's own slashes kept."""
    assert str(parts) == key


@pytest.mark.parametrize(("parts", "key"), KEYS)
def test_data_key_is_read(parts: DataKey, key: str) -> None:
    """Reading a data key gives the parts it was made of."""
    assert parse_data_key(key) == parts


@pytest.mark.parametrize(
    "key", ["", "0", "0/chatter", "0/chatter/type", "x/chatter/type/hash", "-1/a/b/c", "@ros2_lv/0/a/b"]
)
def test_other_keys_are_none(key: str) -> None:
    """A key with too few chunks or without a domain number is no data key."""
    assert parse_data_key(key) is None


@pytest.mark.parametrize(("ros", "dds"), TYPES)
def test_type_names_convert_both_ways(ros: str, dds: str) -> None:
    """ROS and DDS spellings of a type name convert into each other."""
    assert (dds_type(ros), ros_type(dds)) == (dds, ros)


@pytest.mark.parametrize("name", ["", "plain", "pkg::msg::Name_", "pkg::msg::dds_::Name"])
def test_foreign_type_names_stay(name: str) -> None:
    """A name that is not in the DDS form is returned unchanged."""
    assert ros_type(name) == name
