"""Copies of messages that do not go through CDR."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from graphflow.errors import EncodeError
from graphflow.msgs import registry
from graphflow.msgs.base import Message
from graphflow.msgs.geometry_msgs.msg import Polygon, Twist
from graphflow.msgs.nav_msgs.msg import Path
from graphflow.msgs.sensor_msgs.msg import Image
from graphflow.msgs.std_msgs.msg import Float32, String
from tests.cases import sample
from tests.wire.cdr.test_codec import NAMES, samples
from tests.wire.messages import make, plain

from .test_encode import WRONG, assigned


def shape(value: Any) -> Any:
    """The types of a message, of what its fields hold, and of the elements of its arrays."""
    if isinstance(value, Message):
        return type(value), [shape(getattr(value, f.name)) for f in value.SCHEMA.fields]
    if isinstance(value, np.ndarray):
        return value.dtype, value.shape, value.flags.writeable, value.flags.c_contiguous
    return [shape(item) for item in value] if isinstance(value, list) else type(value)


def parts(value: Any) -> list[Any]:
    """A message, and every message and list in it."""
    if isinstance(value, Message):
        return [value, *(part for f in value.SCHEMA.fields for part in parts(getattr(value, f.name)))]
    return [value, *(part for item in value for part in parts(item))] if isinstance(value, list) else []


@pytest.mark.parametrize("name", sample(NAMES))
def test_a_copy_is_what_a_receiver_would_decode(name: str) -> None:
    """Every type's random messages: the same values of the same types, and nothing of the original in it."""
    codec = registry.codec(name)
    for values in samples(name):
        message = make(name, values)
        copy = codec.clone(message)
        decoded = codec.decode(codec.encode(message))
        assert plain(copy) == plain(decoded) == values
        assert shape(copy) == shape(decoded)
        assert not {id(part) for part in parts(copy)} & {id(part) for part in parts(message)}


@pytest.mark.parametrize(("name", "path", "value", "text"), WRONG)
def test_a_wrong_value_is_told_as_when_encoded(name: str, path: str, value: Any, text: str) -> None:
    """By the field's path; the same node must not work in one process and fail in two."""
    message = assigned(name, path, value)
    with pytest.raises(EncodeError) as error:
        registry.codec(name).clone(message)
    assert text in str(error.value)


def test_values_are_converted_as_when_encoded() -> None:
    """Integers become floats, float32 rounds, and tuples and dictionaries become what the type says."""
    twist: Any = Twist()
    twist.linear.x = 3
    assert type(registry.codec("geometry_msgs/msg/Twist").clone(twist).linear.x) is float
    assert registry.codec("std_msgs/msg/Float32").clone(Float32(data=0.1)).data == np.float32(0.1)
    polygon: Any = Polygon()
    polygon.points = ({"x": 1},)
    assert registry.codec("geometry_msgs/msg/Polygon").clone(polygon).points[0].x == 1.0

    class Shout(str):
        """Text of another class."""

    text = String()
    text.data = Shout("hey")
    assert type(registry.codec("std_msgs/msg/String").clone(text).data) is str


@pytest.mark.parametrize("side", [2, 200])
def test_a_matrix_arrives_as_a_row(side: int) -> None:
    """As it does over the network, whether it is small and copied or large and lent; the sender's stays a matrix."""
    image: Any = Image()
    image.data = np.arange(side * side, dtype=np.uint8).reshape(side, side)
    codec = registry.codec("sensor_msgs/msg/Image")
    for _ in range(2):
        assert shape(codec.clone(image)) == shape(codec.decode(codec.encode(image)))
    codec.clone(image)
    assert codec.clone(image).data.shape == (side * side,)
    assert image.data.shape == (side, side)


def test_two_copies_share_nothing_that_can_change() -> None:
    """Whatever one receiver does with its message, the other's stays as it was."""
    codec = registry.codec("nav_msgs/msg/Path")
    path: Any = Path(poses=[{"header": {"frame_id": "map"}}])
    first = codec.clone(path)
    second = codec.clone(first)
    first.poses[0].pose.position.x = 9.0
    first.poses.append(None)
    assert second == path
