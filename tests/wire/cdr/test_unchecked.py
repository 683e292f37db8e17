"""Messages of values that are not checked."""

from __future__ import annotations

import numpy as np

from graphflow.msgs.geometry_msgs.msg import Vector3
from graphflow.msgs.sensor_msgs.msg import Image
from graphflow.msgs.std_msgs.msg import Empty, Header, UInt8
from graphflow.wire.cdr.unchecked import LENT, unchecked, unchecked_class


def test_values_by_position() -> None:
    """In the order of the fields, as the message class, and whatever they are."""
    message = unchecked(Vector3, 1.0, 2.0, "three")
    assert type(message) is Vector3
    assert [message.x, message.y, message.z] == [1.0, 2.0, "three"]
    assert unchecked(UInt8, 1000).data == 1000
    assert unchecked(Empty) == Empty()


def test_messages_with_arrays() -> None:
    """None of theirs is lent."""
    data = np.zeros(3, np.uint8)
    message = unchecked(Image, Header(), 1, 3, "mono8", 0, 3, data)
    assert message.data is data
    assert getattr(message, LENT) is None


def test_a_class_of_the_users() -> None:
    """It has the fields of the message class."""

    class Axis(Vector3):
        pass

    assert type(unchecked(Axis, 0.0, 0.0, 1.0)) is Axis
    assert unchecked_class(Axis) is not unchecked_class(Vector3)
