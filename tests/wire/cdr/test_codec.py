"""Whole codecs: recorded payloads, rosbags and the slow twin as oracles, and payloads that are wrong."""

from __future__ import annotations

import copy
import random
import tracemalloc
from contextlib import suppress
from functools import cache
from typing import Any

import numpy as np
import pytest
from rosbags.typesys import Stores, get_typestore

from graphflow.errors import DecodeError
from graphflow.msgs import registry
from tests.cases import sample, slow
from tests.wire import slow_cdr
from tests.wire.messages import make, message_names, plain, random_values

NAMES = message_names()
STORE = get_typestore(Stores.ROS2_JAZZY)
IN_STORE = [n for n in NAMES if n in STORE.fielddefs]
PER_TYPE = 12
"""Random messages made of each type."""

XX = "xx"
VECTORS: list[tuple[str, dict[str, Any], str]] = [
    ("std_msgs/msg/String", {"data": "hello"}, "00010000 06000000 68656c6c6f00"),
    ("std_msgs/msg/String", {"data": ""}, "00010000 01000000 00"),
    ("std_msgs/msg/Empty", {}, "00010000 00"),
    (
        "odd_shapes/msg/Mixed",
        {"a": True, "b": -2, "c": 7, "d": 1.5, "e": 9, "f": -1, "g": 0.5},
        "00010000 01 xx feff 07 xxxxxx 000000000000f83f 09 xxxxxxxxxxxxxx ffffffffffffffff 0000003f",
    ),
    (
        "odd_shapes/msg/DoublesThenLong",
        {"a": 1, "b": [], "c": 2, "d": 3},
        "00010000 01 xxxxxx 00000000 02 xxxxxxxxxxxxxx 0300000000000000",
    ),
    (
        "odd_shapes/msg/DoublesThenLong",
        {"a": 1, "b": [1.0], "c": 2, "d": 3},
        "00010000 01 xxxxxx 01000000 000000000000f03f 02 xxxxxxxxxxxxxx 0300000000000000",
    ),
    (
        "odd_shapes/msg/Sequences",
        {"a": [True, False, True], "b": ["a", "bc", ""], "c": [1, 2, 3]},
        "00010000 03000000 010001 xx 03000000 02000000 6100 xxxx 03000000 626300 xx 01000000 00 xx 0100 0200 0300",
    ),
    ("odd_shapes/msg/WideThenByte", {"a": "hé€", "b": 5}, "00010000 03000000 68000000 e9000000 ac200000 05"),
    (
        "odd_shapes/msg/Stamped",
        {"header": {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "map"}, "value": 1.0},
        "00010000 01000000 02000000 04000000 6d617000 000000000000f03f",
    ),
    ("example_interfaces/srv/AddTwoInts_Request", {"a": 2, "b": 3}, "00010000 0200000000000000 0300000000000000"),
]

PARAMETER_EVENT = bytes.fromhex(
    "0001000057222e65c5913507160000002f696e74726f7370656374696f6e5f636c69656e74000000010000000d000000"
    "7573655f73696d5f74696d65000100000000000000000000000000000000000000000000010000000000000000000000"
    "000000000000000000000000000000000000000000000000"
)
BASIC_TYPES_EVENT = bytes.fromhex(
    "0001000000000000acf54965eaf01710010feb7dd37a3779000003000000090300000000010000000000000001000000"
    "000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000"
    "00000000010000000000000000000000"
)


def encoded_slowly(name: str, values: dict[str, Any], order: slow_cdr.Order = "<") -> tuple[bytes, list[bool]]:
    return slow_cdr.encode(registry.message_schema(name), values, registry.message_schema, order)


@cache
def samples(name: str) -> list[dict[str, Any]]:
    """Random messages of a type as plain data, the same in every run."""
    rng = random.Random(name)
    return [random_values(registry.message_schema(name), rng) for _ in range(PER_TYPE)]


def in_rosbags(name: str, values: dict[str, Any]) -> Any:
    """The same message as an object of rosbags."""
    cls = STORE.types[name]
    fields = {}
    for field in registry.message_schema(name).fields:
        value, type_ = values[field.name], field.type
        if type_.array and type_.is_primitive and type_.base != "string":
            value = np.array(value, {"bool": "?", "byte": "u1", "char": "u1"}.get(type_.base, type_.base))
        elif type_.array and not type_.is_primitive:
            value = [in_rosbags(type_.base, item) for item in value]
        elif not type_.is_primitive:
            value = in_rosbags(type_.base, value)
        elif type_.base == "byte" and not type_.array:
            value -= 256 if value > 127 else 0  # rosbags takes a single byte for signed
        fields[field.name] = value
    return cls(**fields) if fields else cls()


@pytest.mark.parametrize(("name", "values", "text"), VECTORS)
def test_upstreams_vectors_are_written(name: str, values: dict[str, Any], text: str) -> None:
    """A message is encoded to the bytes of upstream's C++ serialiser, where those are not padding."""
    text = text.replace(" ", "")
    payload = make(name, values).to_bytes()
    assert len(payload) == len(text) // 2
    shown = "".join(XX if text[i : i + 2] == XX else payload.hex()[i : i + 2] for i in range(0, len(text), 2))
    assert shown == text


@pytest.mark.parametrize(("name", "values", "text"), VECTORS)
@pytest.mark.parametrize("garbage", ["00", "ff"])
def test_upstreams_vectors_are_read(name: str, values: dict[str, Any], text: str, garbage: str) -> None:
    """The bytes of upstream's C++ serialiser give the values back, whatever is in the padding."""
    payload = bytes.fromhex(text.replace(" ", "").replace(XX, garbage))
    assert plain(registry.codec(name).decode(payload)) == values


def test_padding_is_written_as_zeros() -> None:
    """No memory of this process leaks into padding."""
    name, values, text = VECTORS[3]
    assert make(name, values).to_bytes().hex() == text.replace(" ", "").replace(XX, "00")


def test_recorded_parameter_event() -> None:
    """A ParameterEvent that a ROS 2 node sent is read; written again it is the same but for the recording's padding."""
    event = registry.codec("rcl_interfaces/msg/ParameterEvent").decode(PARAMETER_EVENT)
    assert (event.node, event.stamp.sec, event.stamp.nanosec) == ("/introspection_client", 0x652E2257, 0x073591C5)
    (parameter,) = event.new_parameters
    assert (parameter.name, parameter.value.type, parameter.value.bool_value) == ("use_sim_time", 1, False)
    assert event.changed_parameters == event.deleted_parameters == []
    again = event.to_bytes()
    assert again + bytes(len(PARAMETER_EVENT) - len(again)) == PARAMETER_EVENT
    assert len(PARAMETER_EVENT) - len(again) < 4


def test_recorded_service_event() -> None:
    """A service event that a ROS 2 client sent is read, char[16] and bounded sequence of requests included."""
    event = registry.codec("test_msgs/srv/BasicTypes_Event").decode(BASIC_TYPES_EVENT)
    assert event.info.event_type == event.info.SCHEMA.constants[0].value == 0
    assert (event.info.stamp.sec, event.info.stamp.nanosec) == (0x6549F5AC, 0x1017F0EA)
    assert event.info.client_gid.tobytes().hex() == "010feb7dd37a37790000030000000903"
    assert event.info.sequence_number == 1
    assert (len(event.request), len(event.response)) == (1, 0)
    assert event.request[0] == registry.example("test_msgs/srv/BasicTypes_Request")
    again = event.to_bytes()
    assert again + bytes(len(BASIC_TYPES_EVENT) - len(again)) == BASIC_TYPES_EVENT


@pytest.mark.parametrize("name", sample(NAMES))
def test_agrees_with_the_twin(name: str) -> None:
    """Every type's random messages are encoded to the twin's bytes, and decode to what they were."""
    codec = registry.codec(name)
    for values in samples(name):
        message = make(name, values)
        expected, _ = encoded_slowly(name, values)
        payload = codec.encode(message)
        assert payload == expected
        decoded = codec.decode(payload)
        assert decoded == message
        assert plain(decoded) == values
        assert slow_cdr.decode(registry.message_schema(name), payload, registry.message_schema) == values


@pytest.mark.parametrize("name", sample(NAMES))
def test_reads_big_endian(name: str) -> None:
    """Every type's messages are read from big-endian payloads too, with values of this machine's byte order."""
    codec = registry.codec(name)
    for values in samples(name):
        payload, _ = encoded_slowly(name, values, ">")
        decoded = codec.decode(payload)
        assert plain(decoded) == values
        assert codec.encode(decoded) == encoded_slowly(name, values)[0]


@pytest.mark.parametrize("name", sample(NAMES))
def test_ignores_padding_and_surplus(name: str) -> None:
    """Garbage in the padding and bytes after the end change nothing that is read."""
    codec = registry.codec(name)
    for values in samples(name)[:4]:
        payload, padding = encoded_slowly(name, values)
        dirty = bytes(0xEE if is_padding else byte for byte, is_padding in zip(payload, padding, strict=True))
        assert plain(codec.decode(dirty + b"\xee\0\0\0\xee")) == values


@pytest.mark.parametrize("name", sample(IN_STORE))
def test_agrees_with_rosbags(name: str) -> None:
    """Every type that rosbags knows is encoded to rosbags' bytes, padding left aside."""
    for values in samples(name):
        _, padding = encoded_slowly(name, values)
        theirs = bytes(STORE.serialize_cdr(in_rosbags(name, values), name))
        ours = make(name, values).to_bytes()
        assert len(theirs) - len(ours) in range(4)
        assert slow_cdr.masked(ours, padding) == slow_cdr.masked(theirs, padding)


def test_rosbags_knows_most_of_the_messages() -> None:
    """The comparison above is made for the bundled and the fixture packages that rosbags has."""
    packages = {name.split("/")[0] for name in IN_STORE}
    assert packages >= {"std_msgs", "geometry_msgs", "rcl_interfaces", "sensor_msgs", "nav_msgs", "service_msgs"}
    assert len(IN_STORE) > 100


@pytest.mark.parametrize("header", ["", "00", "0001", "000100"])
def test_a_payload_needs_a_header(header: str) -> None:
    """Fewer than four bytes are no payload."""
    for name in ("std_msgs/msg/Empty", "std_msgs/msg/String", "geometry_msgs/msg/Twist"):
        with pytest.raises(DecodeError):
            registry.codec(name).decode(bytes.fromhex(header))


@pytest.mark.parametrize("header", ["01010000", "00020000", "00030000", "000a0000", "ffffffff"])
def test_other_encapsulations_are_refused(header: str) -> None:
    """Parameter lists, XCDR2 and noise are refused with the bytes they begin with."""
    with pytest.raises(DecodeError, match=f"std_msgs/msg/String: payload begins with {header}, not a CDR header"):
        registry.codec("std_msgs/msg/String").decode(bytes.fromhex(header) + bytes(20))


def test_header_options_are_ignored() -> None:
    """The header's last two bytes may hold anything."""
    payload = bytes.fromhex("0001ffff 06000000 68656c6c6f00")
    assert registry.codec("std_msgs/msg/String").decode(payload).data == "hello"


@pytest.mark.parametrize("name", sample(NAMES))
def test_truncation_is_a_decode_error(name: str) -> None:
    """A payload cut off anywhere is a DecodeError that names the type, in both byte orders."""
    codec = registry.codec(name)
    values = max(samples(name), key=lambda v: -abs(len(encoded_slowly(name, v)[0]) - 200))
    for payload in (encoded_slowly(name, values, "<")[0], encoded_slowly(name, values, ">")[0]):
        for length in range(0, len(payload), 1 + len(payload) // 150):
            with pytest.raises(DecodeError, match=f"^{name}: "):
                codec.decode(payload[:length])


FRAGILE = [
    "odd_shapes/msg/Deep",
    "odd_shapes/msg/Bounds",
    "test_msgs/msg/BoundedSequences",
    "test_msgs/msg/WStrings",
    "rcl_interfaces/msg/ParameterEvent",
    "sensor_msgs/msg/PointCloud2",
    "type_description_interfaces/srv/GetTypeDescription_Response",
    "tf2_msgs/msg/TFMessage",
]


@slow
@pytest.mark.parametrize("name", FRAGILE)
def test_flipped_bits_raise_nothing_else(name: str) -> None:
    """Damaged payloads either decode or are a DecodeError; what decodes can be printed and copied."""
    codec, rng = registry.codec(name), random.Random(name)
    payloads = [encoded_slowly(name, values, order)[0] for values in samples(name)[:6] for order in ("<", ">")]
    refused = 0
    for _ in range(400):
        damaged = bytearray(rng.choice(payloads))
        for _ in range(rng.choice([1, 1, 2, 8])):
            damaged[rng.randrange(len(damaged))] ^= 1 << rng.randrange(8)
        try:
            decoded = codec.decode(bytes(damaged))
        except DecodeError:
            refused += 1
        else:
            assert repr(decoded) == repr(copy.copy(decoded))
    assert 0 < refused < 400


@pytest.mark.parametrize("name", FRAGILE)
def test_noise_raises_nothing_else(name: str) -> None:
    """Random bytes behind a good header either decode or are a DecodeError."""
    codec, rng = registry.codec(name), random.Random(name)
    for _ in range(200):
        payload = rng.choice([b"\0\1\0\0", b"\0\0\0\0"]) + rng.randbytes(rng.randrange(120))
        with suppress(DecodeError):
            codec.decode(payload)


@pytest.mark.parametrize("name", FRAGILE)
@pytest.mark.parametrize("claim", [2**32 - 1, 2**31, 2**28, 5000])
def test_a_claimed_length_is_not_believed(name: str, claim: int) -> None:
    """Wherever a huge length is written into a payload, decoding allocates no more than the payload justifies."""
    codec, rng = registry.codec(name), random.Random(name)
    payload, _ = encoded_slowly(name, samples(name)[0])
    codec.decode(payload)
    tracemalloc.start()
    try:
        for _ in range(25):
            damaged = bytearray(payload)
            at = 4 * rng.randrange(1, len(payload) // 4)
            damaged[at : at + 4] = claim.to_bytes(4, "little")
            with suppress(DecodeError):
                codec.decode(bytes(damaged))
        assert tracemalloc.get_traced_memory()[1] < 2_000_000
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("std_msgs/msg/String", "ffffffff"),
        ("odd_shapes/msg/WideThenByte", "ffffffff 68000000"),
        ("odd_shapes/msg/DoublesThenLong", "00000000 ffffffff 0000000000000000"),
        ("odd_shapes/msg/Sequences", "ffffffff 01"),
        ("odd_shapes/msg/Sequences", "00000000 ffffffff 01000000 00"),
        ("tf2_msgs/msg/TFMessage", "ffffffff 00000000"),
    ],
)
def test_every_kind_of_length_is_checked(name: str, text: str) -> None:
    """Strings, wide strings, numbers, strings in arrays and messages in arrays cannot claim more than there is."""
    with pytest.raises(DecodeError):
        registry.codec(name).decode(bytes.fromhex("00010000" + text.replace(" ", "")))


def test_empty_messages_in_a_sequence_are_counted_by_their_byte() -> None:
    """A sequence of messages without fields needs one byte each."""
    values = {**samples("odd_shapes/msg/Bounds")[0], "nothings": [{}] * 3}
    payload, _ = encoded_slowly("odd_shapes/msg/Bounds", values)
    assert len(registry.codec("odd_shapes/msg/Bounds").decode(payload).nothings) == 3


@pytest.mark.parametrize(("text", "meaning"), [("00000000", ""), ("01000000 00", ""), ("02000000 6100", "a")])
def test_an_empty_string_has_two_forms(text: str, meaning: str) -> None:
    """A string of length 0, without even a terminator, is read as empty."""
    payload = bytes.fromhex("00010000" + text.replace(" ", ""))
    assert registry.codec("std_msgs/msg/String").decode(payload).data == meaning


def test_text_that_is_no_utf8_is_refused() -> None:
    """Bytes that are no UTF-8 are a DecodeError."""
    with pytest.raises(DecodeError, match=r"std_msgs/msg/String: .*utf-8"):
        registry.codec("std_msgs/msg/String").decode(bytes.fromhex("00010000 03000000 ff6100"))


def test_wide_units_beyond_sixteen_bits_are_refused() -> None:
    """A wstring's unit that does not fit UTF-16 is a DecodeError that says so."""
    with pytest.raises(DecodeError, match="code unit above 0xffff"):
        registry.codec("odd_shapes/msg/WideThenByte").decode(bytes.fromhex("00010000 01000000 00000100 05"))
