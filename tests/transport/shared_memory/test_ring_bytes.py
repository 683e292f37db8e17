"""Bytes in shared memory."""

from __future__ import annotations

import mmap
from typing import Any

import numpy as np
import pytest

from graphflow.msgs.registry import codec
from graphflow.msgs.sensor_msgs.msg import Image, JointState
from graphflow.transport.shared_memory.ring_bytes import ring_bytes


def in_memory(payload: bytes, released: list[bool]) -> Any:
    at = mmap.mmap(-1, len(payload) + 100)
    at[50 : 50 + len(payload)] = payload
    return ring_bytes(at, 50, len(payload), lambda: released.append(True))


@pytest.mark.parametrize(
    "message",
    [
        Image(width=3, encoding="mono8", data=[1, 2, 3]),
        JointState(name=["a", "bé"], position=[1.5, -2.0], effort=[0.0]),
        Image(),
    ],
    ids=["image", "joints", "empty"],
)
def test_a_decoder_reads_them(message: Any) -> None:
    """As it reads bytes; with the other byte order, too."""
    payload, released = message.to_bytes(), list[bool]()
    decode = codec(message.SCHEMA.name).decode
    assert decode(in_memory(payload, released)) == message == decode(payload)
    with pytest.raises(Exception, match=r"ends early|ends after"):
        decode(in_memory(payload[:-9], released))


def test_they_are_released_with_the_last_array() -> None:
    """Neither earlier, while a part of an array is in use, nor twice."""
    released: list[bool] = []
    found = in_memory(bytes(range(100)), released)
    array = np.frombuffer(found, np.uint8, 50, 10)
    part = array[5:10]
    del found, array
    assert not released
    assert part.tolist() == [15, 16, 17, 18, 19]
    del part
    assert released == [True]


def test_nobody_writes_to_them() -> None:
    """Neither as bytes nor through arrays; a copy is the copier's own."""
    found = in_memory(b"abc", [])
    for array in (found, np.frombuffer(found, np.uint8)):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    assert (bytes(found), found[1:], found[0], len(found)) == (b"abc", b"bc", 97, 3)
