"""What a class declares, as data: parameters and the values that fit them, and the way into JSON and back."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from typing import Any

import numpy as np
import pytest

from graphflow import ParameterError
from graphflow.errors import Place
from graphflow.interface import (
    COMMON_PARAMETERS,
    EndpointInfo,
    GroupChange,
    GroupInfo,
    HandlerInfo,
    Interface,
    Parameter,
    ParamType,
    may_make,
    type_id,
    type_of,
)


def parameter(type_: ParamType, default: Any, **limits: Any) -> Parameter:
    return Parameter("p", type_, default, Place("here", 1), **limits)


@pytest.mark.parametrize(
    ("type_", "default", "given", "kept"),
    [
        ("float", 1.0, 2, 2.0),
        ("list[float]", [1.0], [1, 2.5], [1.0, 2.5]),
        ("list[float]", [1.0], (1, 2), [1.0, 2.0]),
        ("list[int]", [1], [], []),
        ("bytes", b"", bytearray(b"ab"), b"ab"),
        ("bool", False, True, True),
        ("list[str]", ["a"], ["b", "c"], ["b", "c"]),
        ("int", 0, -(2**63), -(2**63)),
    ],
)
def test_values_that_fit(type_: ParamType, default: Any, given: Any, kept: Any) -> None:
    """Integers widen to floats and sequences to lists; the Python type is always the declared one."""
    fitted = parameter(type_, default).fit(given)

    assert fitted == kept
    assert type(fitted) is type(kept)
    if isinstance(kept, list):
        assert [type(v) for v in fitted] == [type(v) for v in kept]


@pytest.mark.parametrize(
    ("type_", "default", "given", "text"),
    [
        (
            "int",
            1,
            1.5,
            "parameter 'p' is of type integer, 1.5 is not; "
            "its default is 1, an integer: for a double, write 1.0 in here:1",
        ),
        ("int", 1, 20.0, "parameter 'p' is of type integer, 20.0 is not; write 20"),
        ("bool", True, 1.5, "parameter 'p' is of type boolean, 1.5 is not"),
        ("bool", True, "On", "parameter 'p' is of type boolean, 'On' is not; write true: On is a text in YAML 1.2"),
        ("bool", True, "no", "parameter 'p' is of type boolean, 'no' is not; write false: no is a text in YAML 1.2"),
        ("int", 1, True, "parameter 'p' is of type integer, True is not"),
        ("int", 1, 2**63, "parameter 'p' is of type integer, 9223372036854775808 is not"),
        ("float", 1.0, "1", "parameter 'p' is of type double, '1' is not"),
        ("float", 1.0, "\u20131.5", "parameter 'p' is of type double, '\u20131.5' is not; write -1.5"),
        ("float", 1.0, True, "parameter 'p' is of type double, True is not"),
        ("bool", True, 1, "parameter 'p' is of type boolean, 1 is not"),
        (
            "str",
            "",
            1,
            """parameter 'p' is of type string, 1 is not; write '1', with the quotes; in a shell "'1'\"""",
        ),
        (
            "str",
            "",
            True,
            """parameter 'p' is of type string, True is not; write 'true', with the quotes; in a shell "'true'\"""",
        ),
        ("str", "", None, "parameter 'p' is of type string, None is not"),
        ("list[int]", [1], [1, 2.5], "parameter 'p' is of type integer array, 2.5 is not"),
        ("list[int]", [1], 1, "parameter 'p' is of type integer array, 1 is not"),
        ("list[str]", ["a"], {"a": 1}, "parameter 'p' is of type string array, {'a': 1} is not"),
    ],
)
def test_values_of_another_type(type_: ParamType, default: Any, given: Any, text: str) -> None:
    """The error has name, type and value."""
    with pytest.raises(ParameterError) as caught:
        parameter(type_, default).fit(given)

    assert str(caught.value) == text


def test_an_integer_of_an_installed_package() -> None:
    """Its source is not for editing."""
    place = Place("/venv/lib/python3.11/site-packages/sim/turtle.py", 60)
    with pytest.raises(ParameterError, match=r"is of type integer, 2\.5 is not; write an integer, such as 2$"):
        Parameter("background_r", "int", 69, place).fit(2.5)


@pytest.mark.parametrize(
    ("limits", "inside", "outside", "text"),
    [
        ({"ge": 0, "le": 5}, [0, 5, 2.5], [-0.1, 5.1, math.nan], "0 to 5"),
        ({"gt": 0}, [0.001], [0, -1, math.nan], "more than 0"),
        ({"lt": 1}, [0.999], [1, 2], "less than 1"),
        ({"ge": 2}, [2, math.inf], [1.9], "at least 2"),
        ({"le": 2}, [2, -math.inf], [2.1], "at most 2"),
        ({"gt": 0, "le": 100}, [0.1, 100], [0, 101], "more than 0 and at most 100"),
    ],
)
def test_ranges(limits: dict[str, float], inside: list[float], outside: list[float], text: str) -> None:
    """Limits are inclusive unless they are called gt and lt; the error names the range and the unit."""
    made = parameter("float", inside[0], unit="m", **limits)
    for value in inside:
        assert made.fit(value) == value
    for value in outside:
        with pytest.raises(ParameterError, match=f"parameter 'p' = .* is out of range: {text} m$"):
            made.fit(value)


def test_a_range_holds_for_every_element() -> None:
    """A list is as wrong as its worst element."""
    with pytest.raises(ParameterError, match="'p' = 10 is out of range: 0 to 9"):
        parameter("list[int]", [1, 2], ge=0, le=9).fit([1, 10])


@pytest.mark.parametrize(
    ("type_", "limits", "inside", "outside"),
    [
        ("int", {"ge": 0, "le": 10, "step": 3}, [0, 3, 9, 10], [1, 8]),
        ("int", {"step": 5}, [0, -5, 100], [3]),
        ("float", {"ge": 1.0, "le": 2.0, "step": 0.1}, [1.0, 1.1, 1.7000000000000002, 2.0], [1.05, 1.99]),
        ("float", {"step": 0.25}, [0.25, -1.5, math.inf], [0.3]),
        ("list[int]", {"ge": 1, "step": 2}, [[1, 3], []], [[1, 2]]),
    ],
)
def test_steps(type_: ParamType, limits: dict[str, float], inside: list[Any], outside: list[Any]) -> None:
    """Values are the lower limit and multiples of the step more; both limits are always allowed."""
    made = parameter(type_, inside[0], **limits)
    for value in inside:
        assert made.fit(value) == value
    for value in outside:
        with pytest.raises(ParameterError, match=r"is not a valid step: .* plus a multiple of"):
            made.fit(value)


def test_a_value_that_is_too_large_for_a_double() -> None:
    """The number is not written out in full."""
    with pytest.raises(ParameterError, match=r"^parameter 'p' = 1000000000\d*\.\.\. is too large for a double$"):
        parameter("float", 1.0).fit(10**400)


def test_dynamic_parameters_take_every_type() -> None:
    """And nothing, which is not set; but only what can be a parameter."""
    dynamic = parameter("int", 1, dynamic=True)

    assert [dynamic.fit(v) for v in ("x", (1, 2), 2.5, None)] == ["x", [1, 2], 2.5, None]
    with pytest.raises(ParameterError, match="cannot be a parameter"):
        dynamic.fit({"x": 1})


@pytest.mark.parametrize(
    ("value", "type_", "number"),
    [
        (True, "bool", 1),
        (1, "int", 2),
        (1.0, "float", 3),
        ("", "str", 4),
        (b"", "bytes", 5),
        ([True], "list[bool]", 6),
        ((1, 2), "list[int]", 7),
        ([1, 2.0], "list[float]", 8),
        (["a"], "list[str]", 9),
    ],
)
def test_types_of_values(value: Any, type_: ParamType, number: int) -> None:
    """A bool is no integer, and whole numbers among others are floats; the numbers are ROS 2's."""
    assert (type_of(value), type_id(value)) == (type_, number)


@pytest.mark.parametrize("value", [None, [], [None], [b"x"], [[1]], [1, True], [1, "a"], {}, object(), np.zeros(2)])
def test_values_that_cannot_be_parameters(value: Any) -> None:
    """Their type cannot be told, or is none of ROS 2's."""
    with pytest.raises(ParameterError, match="cannot be a parameter: use a bool, int, float, str, bytes, or a list of"):
        type_of(value)
    with pytest.raises(ParameterError, match="a mapping, whose keys are parameters of their own"):
        type_of({"a": 1})


def test_what_is_not_set_has_no_type() -> None:
    """Its number is 0."""
    assert type_id(None) == 0


@pytest.mark.parametrize(
    ("dynamic", "name", "may"),
    [
        (True, "/any/name", True),
        (False, "/any/name", False),
        ((), "/any/name", False),
        (("*/pose",), "/turtle1/pose", True),
        (("*/pose",), "/turtle1/posed", False),
        (("/a", "/b/*"), "/b/c", True),
        (("/A",), "/a", False),
    ],
)
def test_names_made_at_run_time(dynamic: bool | tuple[str, ...], name: str, may: bool) -> None:
    """Any, none, or those that a pattern matches, letter for letter."""
    assert may_make(dynamic, name) is may


def test_every_kind_of_declaration_survives_json() -> None:
    """Bytes, which JSON does not have, and limits, groups and patterns included."""
    here = Place("here.py", 3, 1)
    interface = Interface(
        class_path="nodes.robot:Robot",
        node_name="robot",
        place=here,
        doc="A robot.",
        endpoints=(EndpointInfo("action client", "go", "x/action/Go", "going", here),),
        params=(
            Parameter("raw", "bytes", b"\0\xff", here),
            Parameter("gain", "list[float]", [1.0, 2.5], here, "N", "How much.", ge=0.0, lt=5.0, step=0.5),
            Parameter("any", "int", 1, here, read_only=True, dynamic=True),
        ),
        handlers=(HandlerInfo("tick", "timer", here, "io", False, True),),
        groups={"io": GroupInfo(2, "drop_old", True), "all": GroupInfo(None)},
        dynamic_names=("*/pose",),
    )

    assert Interface.from_json(json.loads(json.dumps(interface.to_json()))) == interface


def test_a_change_of_a_group_survives_json() -> None:
    """What a graph file says of groups reaches the node's process."""
    change = GroupChange(("tick", "heard"), 2, True, "drop_new", False)

    assert GroupChange.from_json(json.loads(json.dumps(asdict(change)))) == change


def test_every_class_has_the_common_parameters() -> None:
    """Whatever it declares itself; other names it has not."""
    own = parameter("int", 1)
    interface = Interface("m:C", "c", Place("here.py"), params=(own,))

    assert interface.param("p") is own
    assert interface.param("use_sim_time") is COMMON_PARAMETERS["use_sim_time"]
    assert interface.param("q") is None
