"""What is set in launch files of ROS's."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from graphflow.errors import Place
from graphflow.launchfiles.settings import pair, parameter, params, ros_arguments, setting
from graphflow.markup.source import Data
from graphflow.markup.tree import Item, located

HERE = Place("f.yaml", 1, 1)


def complained(place: Place, text: str) -> None:
    raise AssertionError(text)


@pytest.mark.parametrize(
    ("name", "said", "expected"),
    [
        ("push_ros_namespace", {"namespace": "lab"}, ("namespace", "lab")),
        ("push_ros_namespace", {"namespace": "lab", "unless": "$(var x)"}, ("namespace", "$(if $(var x) '' lab)")),
        ("set_parameter", {"name": "rate", "value": "2"}, ("params", {"rate": 2})),
        ("set_use_sim_time", {"value": "true"}, ("params", {"use_sim_time": True})),
        ("set_parameters_from_file", {"filename": "p.yaml"}, ("params_file", ["p.yaml"])),
        ("set_remap", {"from": "a", "to": "b"}, ("remap", {"a": "b"})),
        ("set_env", {"name": "A", "value": "1"}, ("env", {"A": "1"})),
        (
            "append_env",
            {"name": "A", "value": "x", "prepend": "true"},
            ("env", {"A": "x$(if $(not-equals '$(optenv A)' '') : '')$(optenv A)"}),
        ),
    ],
)
def test_what_holds_for_all_that_follows(name: str, said: Any, expected: tuple[str, Any]) -> None:
    """Becomes a setting of a group; variables stay texts."""
    key, value = setting(name, located(said, HERE), complained)
    assert (key, value.plain()) == expected


def test_a_missing_file_is_told() -> None:
    """With its attribute, and where."""
    told: list[str] = []
    item = located({"file": "p.yaml"}, HERE)
    _, value = setting("set_parameters_from_file", item, lambda place, text: told.append(f"{place}: {text}"))
    assert (value.plain(), told) == ([], ["f.yaml:1:1: set_parameters_from_file: the attribute 'filename' is missing"])


def test_a_missing_attribute_is_told() -> None:
    """With its name, and where."""
    told: list[str] = []
    found = pair(located({"value": "1"}, HERE), "name", "value", lambda place, text: told.append(f"{place}: {text}"))
    assert (found.plain(), told) == (
        {},
        ["f.yaml:1:1: the attribute 'name' is missing; one is written name: ..., value: ..."],
    )
    told.clear()
    found = pair(
        located({"from": "a", "too": "b"}, HERE), "from", "to", lambda place, text: told.append(f"{place}: {text}")
    )
    assert (found.plain(), told) == ({}, ["f.yaml:1:1: unknown attribute 'too'; did you mean 'to'?"])


def test_parameters_and_files_of_them() -> None:
    """Values keep their types, unless another is given; nested ones stay nested."""
    given: list[Data] = [
        {"name": "a", "value": 10, "type": "float"},
        {"name": "b", "value": "1e3"},
        {"from": "p.yaml"},
        {"name": "c", "param": [{"name": "d", "value": "true", "type": "bool"}]},
    ]
    entries: dict[str, Item] = {}
    params(located({"param": given}, HERE), entries, complained, complained)
    assert {key: item.plain() for key, item in entries.items()} == {
        "params_file": ["p.yaml"],
        "params": {"a": 10.0, "b": "1e3", "c": {"d": True}},
    }


@pytest.mark.parametrize(
    ("value", "kind", "expected"),
    [
        ("$(var a)", "", "$(var a)"),
        ("$(var a)1", "", "$(as yaml $(var a)1)"),
        ("$(env A)", "", "$(as yaml $(env A))"),
        ("$(var a)", "float", "$(as float $(var a))"),
        ("['$(var a)1', 'b']", "yaml", "$(as yaml \"['$(var a)1', 'b']\")"),
        (["$(var a)1", "b"], "", ["$(as yaml $(var a)1)", "b"]),
        ([1, "$(var a)"], "list_of_float", [1.0, "$(as float $(var a))"]),
        ("0042", "", "0042"),
        ([2, 3.1], "", [2.0, 3.1]),
        (["a", "1"], "", ["a", "1"]),
        ("0042", "int", 42),
        ("1", "bool", True),
    ],
)
def test_the_type_of_a_parameter(value: Any, kind: str, expected: Any) -> None:
    """Of a text with substitutions it is known when they have been made."""
    assert parameter(located(value, HERE), kind, complained).plain() == expected


def test_a_parameter_of_another_type() -> None:
    """Is told with its place, and so is an attribute that means nothing."""
    told: list[str] = []
    given: Data = {"param": [{"name": "a", "value": "x", "type": "int", "valeu": 1}]}
    params(located(given, HERE), {}, lambda place, text: told.append(f"{place}: {text}"), complained)
    assert told == [
        "f.yaml:1:1: param: unknown attribute 'valeu'; did you mean 'value'?",
        "f.yaml:1:1: param: expected an integer, got 'x'",
    ]


def test_words_for_ros() -> None:
    """Remaps, parameters and the level of the log; what a node here does not know is noted."""
    words = "--ros-args -r a:=b -p rate:=2 --log-level DEBUG --fast yes"
    entries: dict[str, Item] = {}
    noted: list[str] = []
    ros_arguments(located({"args": words}, HERE), entries, lambda place, text: noted.append(text))
    assert {key: item.plain() for key, item in entries.items()} == {
        "remap": {"a": "b"},
        "params": {"rate": 2},
        "log_level": "debug",
    }
    assert noted == ["args: the node here does not know --fast; it is left out"]


def test_a_file_with_substitutions() -> None:
    """They are made where that is asked for."""
    entries: dict[str, Item] = {}
    files: list[Data] = [
        {"from": "$(dirname)/a b.yaml", "allow_substs": True},
        {"from": "c.yaml", "allow_substs": "false"},
    ]
    params(located({"param": files}, HERE), entries, complained, complained)
    assert entries["params_file"].plain() == ["$(substituted '$(dirname)/a b.yaml')", "c.yaml"]


def test_a_value_before_a_file_that_sets_it_too(tmp_path: Path) -> None:
    """The other order than in ROS 2 is noted; a value behind the file wins there, too."""
    file = tmp_path / "speeds.yaml"
    file.write_text("/**:\n  ros__parameters:\n    max_speed: 1.25\n")
    value: Data = {"name": "max_speed", "value": 9.0}
    other: Data = {"name": "speed", "value": 2.0}
    told: list[str] = []
    lists: list[list[Data]] = [
        [other, value, {"from": str(file)}],
        [{"from": str(file)}, value],
        [other, {"from": str(file)}],
    ]
    for given in lists:
        params(located({"param": given}, HERE), {}, complained, lambda _, text: told.append(text))
    way = "put the file first, or leave the value out"
    assert told == [f"param: max_speed has a value before speeds.yaml, which wins here, and not in ROS 2: {way}"]
