"""The methods of every message."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest

from graphflow.errors import DecodeError, EncodeError
from graphflow.msgs import base, registry
from graphflow.msgs.geometry_msgs.msg import Point, Twist, Vector3
from graphflow.msgs.std_msgs.msg import Empty, Float32MultiArray, Header, MultiArrayDimension, String


def multi_array(count: int) -> Float32MultiArray:
    return Float32MultiArray(data=np.arange(count, dtype=np.float32))


def test_bytes_and_back() -> None:
    """A message comes back from its own bytes."""
    twist = Twist(linear={"x": 1.5})
    assert Twist.from_bytes(twist.to_bytes()) == twist


def test_from_bytes_refuses_other_bytes() -> None:
    """Bytes that are no such message are a DecodeError."""
    with pytest.raises(DecodeError, match="geometry_msgs/msg/Twist"):
        Twist.from_bytes(String(data="x").to_bytes())


def test_to_bytes_refuses_wrong_values() -> None:
    """A value assigned unseen is found when the message is encoded."""
    twist = Twist()
    twist.linear.x = "abc"  # type: ignore[assignment]
    with pytest.raises(EncodeError, match=r"^Twist\.linear\.x: expected float64, got 'abc'$"):
        twist.to_bytes()


def test_a_type_knows_its_name_and_fields() -> None:
    """A class tells its ROS name, and its fields as ROS prints them."""
    assert Twist.SCHEMA.name == "geometry_msgs/msg/Twist"
    assert Float32MultiArray.get_fields_and_field_types() == {
        "layout": "std_msgs/MultiArrayLayout",
        "data": "float32[]",
    }


def test_equality_is_by_type_and_fields() -> None:
    """Messages are equal when they are of one type and all their fields are."""
    assert Twist(linear={"x": 1}) == Twist(linear=Vector3(x=1.0))
    assert Twist(linear={"x": 1}) != Twist(linear={"x": 2})
    assert Vector3() != Point()
    assert Vector3() != (0.0, 0.0, 0.0)
    assert Empty() == Empty()


def test_equality_looks_into_arrays() -> None:
    """Numeric arrays count element by element, also when one side was assigned as a list."""
    assert multi_array(3) == multi_array(3)
    assert multi_array(3) != multi_array(4)
    assert multi_array(3) != Float32MultiArray(data=[0, 1, 3])
    assigned = Float32MultiArray()
    assigned.data = [0.0, 1.0, 2.0]  # type: ignore[assignment]
    assert assigned == multi_array(3)
    assert multi_array(3) == assigned


def test_a_message_cannot_be_a_key() -> None:
    """Messages can change, so they have no hash."""
    with pytest.raises(TypeError, match="unhashable"):
        hash(String())


def test_repr_shows_type_and_values() -> None:
    """A message prints as its Python name and its fields."""
    assert repr(Header(frame_id="map")) == (
        "std_msgs.msg.Header(stamp=builtin_interfaces.msg.Time(sec=0, nanosec=0), frame_id='map')"
    )
    assert repr(Empty()) == "std_msgs.msg.Empty()"


def test_repr_shortens_long_arrays() -> None:
    """A short array is printed whole, a long one by its beginning and its length."""
    assert "data=array([0.0, 1.0, 2.0])" in repr(multi_array(3))
    text = repr(multi_array(100_000))
    assert len(text) < 300
    assert "100000" in text


def test_fields_cannot_be_invented() -> None:
    """A misspelt field is an error of Python's at once, given or assigned."""
    with pytest.raises(TypeError, match="liner"):
        Twist(liner={"x": 1})  # type: ignore[call-arg]
    with pytest.raises(AttributeError):
        Twist().liner = Vector3()  # type: ignore[attr-defined]


def test_a_shallow_copy_has_the_same_parts() -> None:
    """`copy.copy` makes a message of its own that shares its parts."""
    twist = Twist()
    other = copy.copy(twist)
    assert other == twist
    assert other is not twist
    assert other.linear is twist.linear


def test_a_copy_takes_what_is_there() -> None:
    """A message that holds a wrong value is copied as it is."""
    string = String()
    string.data = 5  # type: ignore[assignment]
    assert copy.copy(string).data == copy.deepcopy(string).data == 5  # type: ignore[comparison-overlap]


def test_a_deep_copy_shares_nothing() -> None:
    """`copy.deepcopy` copies nested messages, lists and arrays, and its arrays can be written."""
    message = Float32MultiArray.from_bytes(
        Float32MultiArray(layout={"dim": [MultiArrayDimension(label="x")]}, data=[1, 2]).to_bytes()
    )
    other = copy.deepcopy(message)
    other.layout.dim[0].label = "y"
    other.data[0] = 9
    assert (message.layout.dim[0].label, message.data.tolist()) == ("x", [1.0, 2.0])


@pytest.mark.parametrize(
    "name", ["geometry_msgs/msg/PoseWithCovarianceStamped", "std_msgs/msg/Empty", "turtlesim/srv/Spawn_Request"]
)
def test_a_message_can_be_pickled(name: str) -> None:
    """A message goes through pickle, as between processes, and comes back of the same class."""
    message = registry.example(name)
    again: Any = pickle.loads(pickle.dumps(message))
    assert again == message
    assert type(again) is type(message)


def test_messages_are_messages() -> None:
    """Every message class is one of `base.Message`, without a dict of its own."""
    assert isinstance(Twist(), base.Message)
    assert not hasattr(Twist(), "__dict__")
