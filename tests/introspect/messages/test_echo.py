"""Messages as text that people and YAML readers understand."""

from __future__ import annotations

import math
import tracemalloc
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from graphflow.introspect.messages.echo import block, csv, flow, plain, scalar, truncated
from graphflow.markup.source import read
from graphflow.msgs import registry
from graphflow.msgs.geometry_msgs.msg import Pose, Twist, Vector3
from graphflow.msgs.rcl_interfaces.msg import ParameterEvent, ParameterValue
from tests.cases import count, slow


def test_plain_is_made_of_dicts_lists_and_scalars() -> None:
    """Messages, arrays and bytes become what JSON knows, all the way down."""
    value = ParameterValue(type=7, integer_array_value=[1, 2], byte_array_value=[0, 255], double_array_value=[0.5])
    found = plain(value)
    assert found["integer_array_value"] == [1, 2]
    assert found["byte_array_value"] == [0, 255]
    assert found["double_array_value"] == [0.5]
    assert {type(v) for v in found.values()} == {int, bool, float, str, list}
    assert plain(Twist(linear=Vector3(x=1))) == {
        "linear": {"x": 1.0, "y": 0.0, "z": 0.0},
        "angular": {"x": 0.0, "y": 0.0, "z": 0.0},
    }
    assert plain(np.float32(0.5)) == 0.5
    assert plain((Vector3(), 1)) == [{"x": 0.0, "y": 0.0, "z": 0.0}, 1]


def test_a_block_as_ros_prints_it() -> None:
    """One field a line, nested ones two spaces in, list items at the level of their name."""
    data = {
        "header": {"stamp": {"sec": 1, "nanosec": 0}, "frame_id": ""},
        "names": ["a", "b c"],
        "points": [{"x": 1.0, "y": [2, 3]}, {"x": -1.5, "y": []}],
        "empty": {},
        "none": [],
        "on": True,
    }
    assert (
        block(data)
        == """\
header:
  stamp:
    sec: 1
    nanosec: 0
  frame_id: ''
names:
- a
- b c
points:
- x: 1.0
  y:
  - 2
  - 3
- x: -1.5
  y: []
empty: {}
none: []
on: true"""
    )


def test_flow_is_one_line() -> None:
    """Flow style has everything on one line."""
    assert flow({"a": {"b": [1, 2.5, "x"]}, "c": []}) == "{a: {b: [1, 2.5, x]}, c: []}"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "null"),
        (True, "true"),
        (False, "false"),
        (3, "3"),
        (-2.5, "-2.5"),
        (1e16, "1e+16"),
        (1e-7, "1e-07"),
        (math.inf, ".inf"),
        (-math.inf, "-.inf"),
        (math.nan, ".nan"),
        ("", "''"),
        ("hello world", "hello world"),
        ("3", "'3'"),
        ("true", "'true'"),
        ("1e3", "'1e3'"),
        ("null", "'null'"),
        ("on", "on"),
        ("12:30", "12:30"),
        ("a: b", "'a: b'"),
        ("it's", "it's"),
        ("'it'", "'''it'''"),
        ("- a", "'- a'"),
        ("a # b", "'a # b'"),
        (" a", "' a'"),
        ("a\nb", '"a\\nb"'),
        ("\x07", '"\\x07"'),
        ('say "hi"\n', '"say \\"hi\\"\\n"'),
        ("é", "é"),
        ("...", "..."),
    ],
)
def test_scalars(value: Any, text: str) -> None:
    """A value is written so that it reads back as what it is, with quotes only where they are needed."""
    assert scalar(value) == text


def test_long_lists_and_strings_are_cut() -> None:
    """Cuts are marked at every level; None cuts nothing."""
    data = {"a": [1, 2, 3, 4], "b": "abcdef", "c": {"d": ["abcdef", "ab"]}, "e": [1, 2, 3]}
    assert truncated(data, 3) == {
        "a": [1, 2, 3, "..."],
        "b": "abc...",
        "c": {"d": ["abc...", "ab"]},
        "e": [1, 2, 3],
    }
    assert truncated(data, None) is data
    assert truncated(["x"] * 200)[127:] == ["x", "..."]


def test_csv_is_the_leaves() -> None:
    """All leaves in the order of the fields, separated by commas."""
    assert csv(plain(Twist(linear=Vector3(x=2.0)))) == "2.0,0.0,0.0,0.0,0.0,0.0"
    assert csv({"a": [1, "x"], "b": {"c": True}}) == "1,x,True"
    assert csv([]) == ""


TEXTS = st.text(st.characters(exclude_categories=["Cs"])) | st.text(
    alphabet="a:-#'\"\\{}[],&*!|>%@` \n\t?.~01é\u2028\r"
)
LEAVES = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | TEXTS
FIELDS = st.from_regex(r"[a-z][a-z0-9_]{0,5}", fullmatch=True).filter(
    lambda name: name not in ("true", "false", "null")
)
DATA = st.recursive(
    LEAVES, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(FIELDS, inner, max_size=3), max_leaves=12
)


@slow
@settings(derandomize=True, max_examples=count(few=100, full=400), deadline=None)
@given(st.dictionaries(FIELDS, DATA, min_size=1, max_size=4))
def test_what_is_printed_reads_back_as_the_same_data(data: dict[str, Any]) -> None:
    """Block and flow style are YAML: whatever a message holds, a program gets it back."""
    assert read(block(data), "block").data == data
    assert read(flow(data), "flow").data == data


@settings(derandomize=True, max_examples=count(few=50, full=200), deadline=None)
@given(TEXTS.filter(lambda text: text != "..."))
def test_a_text_alone_reads_back(text: str) -> None:
    """One string field by itself, as `--field` prints it, is YAML, too."""
    assert read(scalar(text), "scalar").data == text


@pytest.mark.parametrize("message", [Twist(), Pose(), ParameterEvent(node="/a: b"), ParameterValue(string_value="#")])
def test_messages_read_back(message: Any) -> None:
    """Output of `topic echo` is valid input of `topic pub`."""
    from graphflow.msgs.values import from_plain

    assert from_plain(type(message), read(block(plain(message)), "block").data) == message


@slow
def test_long_lists_are_cut_before_they_are_made() -> None:
    """Elements of a large array that are not shown are not converted."""
    message: Any = registry.interface_class("std_msgs/msg/UInt8MultiArray")(data=bytes(20_000_000))
    tracemalloc.start()
    try:
        data = plain(message, 3)
        assert tracemalloc.get_traced_memory()[1] < 100_000
    finally:
        tracemalloc.stop()
    assert data["data"] == [0, 0, 0, 0]
    assert truncated(data, 3)["data"] == [0, 0, 0, "..."]
    assert plain([[1, 2, 3, 4], [5]], 2) == [[1, 2, 3], [5]]
    assert len(plain(message)["data"]) == 20_000_000
