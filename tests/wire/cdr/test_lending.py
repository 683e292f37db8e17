"""Which arrays are shared with readers in the same process, and which are copied."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from graphflow.msgs import registry
from graphflow.msgs.sensor_msgs.msg import Image
from graphflow.msgs.std_msgs.msg import Float64MultiArray
from graphflow.wire.cdr.lending import SMALL, lend

SIZE = 10 * SMALL
CODEC = registry.codec("sensor_msgs/msg/Image")


def zeros() -> Any:
    return np.zeros(SIZE, np.uint8)


def frozen() -> Any:
    array = zeros()
    array.flags.writeable = False
    return array


def received() -> Image:
    message: Image = CODEC.decode(CODEC.encode(Image(data=zeros())))
    return message


held: list[Any] = []


def holding(array: Any) -> Any:
    held.append(array)
    return array


def assigned(array: Any) -> Image:
    """A message whose field is that very array, and not a view of it."""
    message = Image()
    message.data = array
    return message


@pytest.mark.parametrize(
    ("make", "is_shared"),
    [
        pytest.param(lambda: Image(data=zeros()), True, id="an array that the message alone holds"),
        pytest.param(lambda: Image(data=zeros().reshape(10, -1)), True, id="a view that it alone holds"),
        pytest.param(lambda: Image(data=bytes(SIZE)), True, id="bytes"),
        pytest.param(received, True, id="what was received"),
        pytest.param(lambda: Image(data=holding(frozen())), True, id="an array that nobody can write to"),
        pytest.param(lambda: Image(data=holding(zeros())), False, id="an array that somebody holds"),
        pytest.param(lambda: Image(data=holding(zeros())[10:]), False, id="a part of an array that somebody holds"),
        pytest.param(lambda: assigned(zeros()), True, id="an assigned array that it alone holds"),
        pytest.param(lambda: assigned(holding(zeros())), False, id="an assigned array that somebody holds"),
        pytest.param(lambda: Image(data=bytearray(SIZE)), False, id="a bytearray"),
        pytest.param(lambda: Image(data=memoryview(holding(bytearray(SIZE)))), False, id="a view of one"),
        pytest.param(lambda: Image(data=zeros()[:SMALL]), False, id="a small array"),
    ],
)
def test_what_is_shared(make: Callable[[], Image], is_shared: bool) -> None:
    """Only what nobody can change; what a reader has is read-only in any case, and cannot be made writable."""
    message = make()
    before = message.data.copy()
    first, second = CODEC.clone(message).data, CODEC.clone(message).data
    assert np.shares_memory(first, second) is is_shared
    for array in (first, second):
        assert (array == before).all()
        assert not array.flags.writeable
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.flags.writeable = True


def test_the_sender_may_go_on_writing() -> None:
    """Into the message, and into an array of its own that the message was made of; readers notice nothing."""
    frame = zeros()
    mine, given = Image(data=frame), Image(data=zeros())
    copies = [CODEC.clone(message).data for message in (mine, given)]
    frame[:] = 1
    mine.data[0] = 2
    given.data[:] = 3
    given.data[0] += 1
    assert [array.any() for array in copies] == [False, False]
    assert given.data[:2].tolist() == [4, 3]
    assert CODEC.clone(given).data[:2].tolist() == [4, 3]


def test_a_message_that_is_not_touched_is_lent_again() -> None:
    """Publishing one message over and over copies nothing."""
    message = Image(data=zeros())
    first, second = CODEC.clone(message).data, CODEC.clone(message).data
    assert np.shares_memory(first, second)
    message.data[0] = 1
    assert not np.shares_memory(first, CODEC.clone(message).data)


@pytest.mark.parametrize("touch", [copy.copy, copy.deepcopy, lambda m: pickle.loads(pickle.dumps(m))])
def test_copies_of_a_lent_message(touch: Callable[[Image], Image]) -> None:
    """They have all of it, and can be written to."""
    message = Image(height=3, data=zeros())
    reader = CODEC.clone(message).data
    other = touch(message)
    assert other == message
    other.data[0] = 7
    assert reader[0] == 0


def test_a_lent_field_that_is_set_anew() -> None:
    """The new array counts."""
    message = Image(data=zeros())
    CODEC.clone(message)
    message.data = np.ones(SIZE, np.uint8)
    assert CODEC.clone(message).data.all()
    assert message.data.all()


def test_what_is_no_field_is_still_told() -> None:
    """Lending does not get in the way of the message about a misspelt field."""
    message: Any = Image(data=zeros())
    CODEC.clone(message)
    with pytest.raises(AttributeError, match=r"^'Image' object has no attribute 'dat'$") as caught:
        _ = message.dat
    assert (caught.value.name, caught.value.obj) == ("dat", message)


def test_arrays_of_other_objects_are_copied() -> None:
    """A field may hold anything that has the fields of a message; nothing is taken from that."""

    class Alike:
        def __init__(self) -> None:
            self.data = np.zeros(SIZE, np.float64)

    other = Alike()
    array = lend(other, "data", "float64")
    assert not np.shares_memory(array, other.data)


def test_arrays_of_another_type_are_converted() -> None:
    """As when encoded."""
    message: Any = Float64MultiArray()
    message.data = np.arange(SIZE, dtype=np.float32)
    copied = registry.codec("std_msgs/msg/Float64MultiArray").clone(message).data
    assert copied.dtype == np.float64
    assert copied[5] == 5.0
