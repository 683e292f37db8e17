"""The values of decoded messages."""

from __future__ import annotations

import tracemalloc
from typing import Any

import numpy as np
import pytest

from graphflow.errors import DecodeError
from graphflow.msgs import registry
from graphflow.msgs.rcl_interfaces.msg import ParameterValue
from graphflow.wire.cdr.codec import Codec
from graphflow.wire.schema import Field, FieldType, Message
from tests.cases import slow
from tests.wire.messages import make, types_of


def round_trip(name: str, **values: Any) -> Any:
    message: Any = make(name, values)
    return type(message).from_bytes(message.to_bytes())


def test_a_decoded_message_is_of_its_class() -> None:
    """Decoding gives objects of the classes that are imported, nested ones too."""
    pose: Any = round_trip("geometry_msgs/msg/PoseStamped")
    assert type(pose.header.stamp) is registry.interface_class("builtin_interfaces/msg/Time")
    assert type(pose) is registry.interface_class("geometry_msgs/msg/PoseStamped")


def test_scalars_are_pythons() -> None:
    """Single numbers are Python's own types, never numpy's."""
    message = round_trip("test_msgs/msg/BasicTypes", bool_value=True, float32_value=0.5)
    types = {type(getattr(message, f.name)) for f in message.SCHEMA.fields}
    assert types == {bool, int, float}


@pytest.mark.parametrize("field", ["bool_values", "uint8_values", "int16_values", "float32_values", "float64_values"])
@pytest.mark.parametrize("name", ["test_msgs/msg/Arrays", "test_msgs/msg/BoundedSequences"])
def test_arrays_are_read_only(name: str, field: str) -> None:
    """An array of a received message cannot be written: others hold the same payload."""
    array = getattr(round_trip(name, **{field: [True, False, True] if "bool" in field else [1, 2, 3]}), field)
    assert array.size == 3
    with pytest.raises(ValueError, match="read-only"):
        array[0] = 0


def test_empty_arrays_are_read_only_too() -> None:
    """An empty array is of the type and cannot be written either."""
    array = round_trip("std_msgs/msg/Float32MultiArray").data
    assert (array.size, array.dtype) == (0, np.float32)
    assert not array.flags.writeable


def test_big_endian_arrays_are_read_only_and_native() -> None:
    """Arrays of a big-endian payload have this machine's byte order and cannot be written."""
    payload = bytes.fromhex("00000000 00000000 00000000 00000002 3f800000 c0000000")
    array = registry.codec("std_msgs/msg/Float32MultiArray").decode(payload).data
    assert (array.tolist(), array.dtype.isnative) == ([1.0, -2.0], True)
    assert not array.flags.writeable


def test_arrays_lie_in_the_payload() -> None:
    """A numeric array is a view of the payload, not a copy."""
    message: Any = make("sensor_msgs/msg/Image", {"data": bytes(range(256))})
    payload = message.to_bytes()
    image = type(message).from_bytes(payload)
    assert np.shares_memory(image.data, np.frombuffer(payload, np.uint8))


def test_sequences_of_messages_are_lists() -> None:
    """Sequences of strings and messages are lists that can be changed."""
    message = round_trip("odd_shapes/msg/Bounds", labels=["a"], colors=[{"r": 0.5}])
    message.labels.append("b")
    message.colors[0].r = 1.0
    assert (message.labels, message.colors[0].r) == (["a", "b"], 1.0)


def test_decoded_messages_share_nothing() -> None:
    """Two messages from one payload can be changed apart."""
    payload = make("geometry_msgs/msg/Twist", {}).to_bytes()
    first, second = (registry.codec("geometry_msgs/msg/Twist").decode(payload) for _ in range(2))
    first.linear.x = 1.0
    assert second.linear.x == 0.0


def test_bounds_are_not_checked_when_read() -> None:
    """A sequence longer than its bound is read as sent: the sender has checked it, or knows another version."""
    payload = bytes.fromhex("00010000 07000000 73697873697800 00") + bytes(150)
    message = registry.codec("odd_shapes/msg/Bounds").decode(payload)
    assert message.short == "sixsix"


def test_any_byte_but_zero_is_true() -> None:
    """A bool of another writer may be any byte."""
    decoded = registry.codec("std_msgs/msg/Bool").decode(b"\0\1\0\0\x02")
    assert decoded.data is True


def test_a_decode_error_names_type_and_size() -> None:
    """The error tells the type, what was wrong and how much had come."""
    with pytest.raises(DecodeError, match=r"^geometry_msgs/msg/Twist: the payload of 12 bytes ends early$"):
        registry.codec("geometry_msgs/msg/Twist").decode(b"\0\1\0\0" + bytes(8))
    with pytest.raises(DecodeError, match=r"^std_msgs/msg/String: a string ends after the payload \(10 bytes\)$"):
        registry.codec("std_msgs/msg/String").decode(bytes.fromhex("00010000 09000000 6161"))
    with pytest.raises(DecodeError, match=r"^tf2_msgs/msg/TFMessage: a sequence claims more than the payload holds"):
        registry.codec("tf2_msgs/msg/TFMessage").decode(bytes.fromhex("00010000 02000000 6161"))
    with pytest.raises(
        DecodeError, match=r"^std_msgs/msg/UInt8MultiArray: an array ends after the payload \(17 bytes\)$"
    ):
        registry.codec("std_msgs/msg/UInt8MultiArray").decode(bytes.fromhex("00010000 00000000 00000000 02000000 61"))


def test_plain_arrays() -> None:
    """As lists, for those who do without numpy; a length that is a lie is refused all the same."""
    value = ParameterValue(
        byte_array_value=b"ab", bool_array_value=[True, False], integer_array_value=[3, -4], double_array_value=[1.5]
    )
    name = "rcl_interfaces/msg/ParameterValue"
    found = registry.plain_codec(name).decode(value.to_bytes())
    assert (found.byte_array_value, found.bool_array_value) == ([97, 98], [True, False])
    assert (found.integer_array_value, found.double_array_value) == ([3, -4], [1.5])
    big = bytes.fromhex("00000000 00000000 00000000 00000002 3f800000 c0000000")
    assert registry.plain_codec("std_msgs/msg/Float32MultiArray").decode(big).data == [1.0, -2.0]
    with pytest.raises(DecodeError, match="ends after the payload"):
        registry.plain_codec("std_msgs/msg/Float64MultiArray").decode(b"\0\1\0\0" + bytes(8) + b"\xff" * 4)


EMPTY, ROW = Message("p/msg/Empty"), Message("p/msg/Row", (Field("cells", FieldType("p/msg/Empty", 0, "unbounded")),))
TABLE = Message("p/msg/Table", (Field("rows", FieldType("p/msg/Row", 0, "unbounded")),))
TYPES = types_of({m.name: m for m in (EMPTY, ROW, TABLE)})


def table(rows: int, cells: int) -> bytes:
    """A payload of rows with cells; an empty message is one byte."""
    row = cells.to_bytes(4, "little") + bytes(cells)
    return b"\0\1\0\0" + rows.to_bytes(4, "little") + row * rows


@slow
def test_lists_of_more_values_than_allowed() -> None:
    """Are refused by their counts before objects are made of them, lists in lists counted together."""
    decode = Codec(TABLE, TYPES._replace(values=1_000 * 2 + 1_000 * 100)).decode
    for _ in range(2):  # each message has as many
        assert len(decode(table(1_000, 100)).rows) == 1_000
    tracemalloc.start()
    try:
        for payload in (table(1_000, 104), table(1, 10_000_000), table(10_000_000, 0)):
            with pytest.raises(DecodeError, match="p/msg/Table: its lists have more than 102,000 values"):
                decode(payload)
        assert tracemalloc.get_traced_memory()[1] < 150_000_000
    finally:
        tracemalloc.stop()


def test_values_of_types_from_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    """May be fewer than those of types that are installed here."""
    monkeypatch.setattr(registry, "_foreign", {"decode_msgs/msg/Rows": "std_msgs/Empty[] rows"})
    for codec in (registry.codec, registry.plain_codec):
        with pytest.raises(DecodeError, match="more than 2,000,000 values"):
            codec("decode_msgs/msg/Rows").decode(b"\0\1\0\0" + (2_000_001).to_bytes(4, "little") + bytes(2_000_001))
        assert codec("test_msgs/msg/Arrays").decode(registry.example("test_msgs/msg/Arrays").to_bytes())
