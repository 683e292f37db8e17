"""Strict message classes."""

from __future__ import annotations

import copy
import pickle
from array import array
from typing import Any

import pytest

from graphflow.errors import EncodeError
from graphflow.msgs import registry
from graphflow.rclpy.messages import classes
from tests.cases import sample, slow
from tests.wire.messages import message_names

HERE = {package for package in {name.split("/")[0] for name in message_names()} if registry.package_folders(package)}
"""The packages of these messages that come with graphflow."""


def cls(name: str) -> Any:
    return classes.interface_class(name)


def test_a_message_shows_itself_as_in_ros_2() -> None:
    """With the names of its classes, and arrays as plain lists."""
    vector = cls("geometry_msgs/msg/Vector3")(x=1.5)
    assert repr(vector) == "geometry_msgs.msg.Vector3(x=1.5, y=0.0, z=0.0)"
    assert "ranges=[1.0, 2.0]" in repr(cls("sensor_msgs/msg/LaserScan")(ranges=[1.0, 2.0]))


def test_assignment_is_checked() -> None:
    """And so are the constructor's arguments; what is refused changes nothing."""
    twist = cls("geometry_msgs/msg/Twist")()
    with pytest.raises(AssertionError, match="must be of type 'float'"):
        twist.linear.x = 1
    with pytest.raises(AssertionError, match="must be a sub message of type 'Vector3'"):
        twist.linear = 3.0
    with pytest.raises(AssertionError, match="Invalid arguments passed to constructor: speed"):
        cls("geometry_msgs/msg/Twist")(speed=1.0)
    with pytest.raises(AttributeError):
        twist.speed = 1.0
    assert twist == cls("geometry_msgs/msg/Twist")()


def test_sequences_of_numbers_are_arrays() -> None:
    """That can be appended to; fixed arrays are numpy's."""
    scan = cls("sensor_msgs/msg/LaserScan")()
    scan.ranges.append(2.5)
    assert scan.ranges == array("f", [2.5])
    assert cls("sensor_msgs/msg/Imu")().orientation_covariance.shape == (9,)
    assert not cls("sensor_msgs/msg/LaserScan")().ranges


@pytest.mark.parametrize("name", sample([n for n in message_names() if n.split("/")[0] in HERE]))
def test_a_strict_message_has_the_same_bytes_as_graphflows_own(name: str) -> None:
    """Filled by its own codec from the bytes of a message of graphflow's, it gives them back."""
    payload = registry.example(name).to_bytes()
    strict = classes.decode(classes.message_class(name), payload)
    assert classes.encode(strict) == payload
    assert classes.encode(classes.message_class(name)()) == payload
    assert strict == classes.decode(classes.message_class(name), payload)


def test_values_of_every_kind_come_back() -> None:
    """Bytes, flags, texts, arrays and nested messages."""
    scan = cls("sensor_msgs/msg/LaserScan")(ranges=[1.0, 2.0], angle_min=-1.5)
    scan.header.frame_id = "laser"
    assert classes.decode(type(scan), classes.encode(scan)) == scan
    value = cls("rcl_interfaces/msg/ParameterValue")
    filled = value(byte_array_value=[b"a", b"\xff"], bool_array_value=[True, False], string_array_value=["é", ""])
    filled.integer_array_value = [-1, 2**62]
    assert classes.decode(value, classes.encode(filled)) == filled
    assert classes.decode(cls("std_msgs/msg/Byte"), classes.encode(cls("std_msgs/msg/Byte")(data=b"z"))).data == b"z"


@slow
def test_what_was_changed_in_place_is_refused_when_it_is_sent() -> None:
    """By the path of the field."""
    value = cls("rcl_interfaces/msg/ParameterValue")(string_array_value=["a"])
    value.string_array_value.append(3)
    with pytest.raises(EncodeError, match=r"ParameterValue\.string_array_value: .*; element 1 is 3$"):
        classes.encode(value)
    path, pose = cls("nav_msgs/msg/Path")(), cls("geometry_msgs/msg/Pose")()
    path.poses.append(pose)
    with pytest.raises(EncodeError, match=r"element 0 is a Pose: write PoseStamped\(pose=\.\.\.\)$"):
        classes.encode(path)
    path.poses[0] = cls("geometry_msgs/msg/Twist")()
    with pytest.raises(EncodeError, match=r"element 0 is a Twist$"):
        classes.encode(path)
    path.poses = ()
    assert classes.encode(path) == classes.encode(type(path)())


def test_messages_can_be_copied_and_pickled() -> None:
    """As code does that keeps them."""
    twist = cls("geometry_msgs/msg/Twist")()
    twist.angular.z = 2.0
    for other in (copy.deepcopy(twist), pickle.loads(pickle.dumps(twist))):
        assert other == twist
        assert other.angular is not twist.angular
    request = cls("std_srvs/srv/SetBool").Request(data=True)
    assert pickle.loads(pickle.dumps(request)) == request


def test_classes_say_which_module_they_are_from() -> None:
    """That of rosidl, which programs make names of types from."""
    assert str(cls("std_msgs/msg/UInt8MultiArray")) == "<class 'std_msgs.msg._u_int8_multi_array.UInt8MultiArray'>"
    service, action = cls("std_srvs/srv/SetBool"), cls("example_interfaces/action/Fibonacci")
    assert {c.__module__ for c in (service, service.Request, service.Event)} == {"std_srvs.srv._set_bool"}
    assert {c.__module__ for c in (action, action.Goal)} == {"example_interfaces.action._fibonacci"}
    assert repr(service.Request()) == "std_srvs.srv.SetBool_Request(data=False)"


def test_constants_and_types_of_fields_are_attributes_of_the_class() -> None:
    """As generated code has them."""
    status = cls("action_msgs/msg/GoalStatus")
    assert status.STATUS_SUCCEEDED == 4
    assert status.get_fields_and_field_types() == {"goal_info": "action_msgs/GoalInfo", "status": "int8"}
    assert status.__slots__ == ("_goal_info", "_status")


def test_services_and_actions_hold_their_messages_and_are_none() -> None:
    """An action also holds what carries it."""
    service, action = cls("example_interfaces/srv/AddTwoInts"), cls("example_interfaces/action/Fibonacci")
    assert service.Request(a=2, b=3).b == 3
    assert action.Impl.SendGoalService.Request().goal == action.Goal()
    for kind in (service, action):
        with pytest.raises(NotImplementedError, match="can not be instantiated"):
            kind()


def test_constants_are_what_their_fields_take() -> None:
    """Those of bytes are bytes."""
    status = cls("diagnostic_msgs/msg/DiagnosticStatus")
    assert status.ERROR == b"\2"
    assert status(level=status.ERROR).level == b"\2"
    assert cls("rcl_interfaces/msg/ParameterType").PARAMETER_BOOL == 1
