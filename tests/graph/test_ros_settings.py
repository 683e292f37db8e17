"""What is set in launch files of ROS's."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.errors import Place
from graphflow.graph.ros_settings import pair, params, ros_words, setting
from graphflow.graph.tree import Item, located

HERE = Place("f.yaml", 1, 1)


def complained(place: Place, text: str) -> None:
    raise AssertionError(text)


@pytest.mark.parametrize(
    ("name", "said", "expected"),
    [
        ("push_ros_namespace", {"namespace": "lab"}, ("namespace", "lab")),
        ("set_parameter", {"name": "rate", "value": "2"}, ("params", {"rate": 2})),
        ("set_use_sim_time", {"value": "true"}, ("params", {"use_sim_time": True})),
        ("set_remap", {"from": "a", "to": "b"}, ("remap", {"a": "b"})),
        ("set_env", {"name": "A", "value": "1"}, ("env", {"A": "1"})),
        ("append_env", {"name": "A", "value": "x", "prepend": "true"}, ("env", {"A": "x:$(optenv A)"})),
    ],
)
def test_what_holds_for_all_that_follows(name: str, said: Any, expected: tuple[str, Any]) -> None:
    """Becomes a setting of a group; variables stay texts."""
    key, value = setting(name, located(said, HERE), complained)
    assert (key, value.plain()) == expected


def test_a_missing_attribute_is_told() -> None:
    """With its name, and where."""
    told: list[str] = []
    found = pair(located({"value": "1"}, HERE), "name", "value", lambda place, text: told.append(f"{place}: {text}"))
    assert (found.plain(), told) == ({}, ["f.yaml:1:1: the attribute 'name' is missing"])


def test_parameters_and_files_of_them() -> None:
    """Values read as YAML does, unless they are said to be texts; nested ones stay nested."""
    said = [
        {"name": "a", "value": "1e3"},
        {"name": "b", "value": "1e3", "type": "str"},
        {"from": "p.yaml"},
        {"name": "c", "param": [{"name": "d", "value": "true"}]},
    ]
    entries: dict[str, Item] = {}
    params(located({"param": said}, HERE), entries, complained)
    assert {key: item.plain() for key, item in entries.items()} == {
        "params_file": ["p.yaml"],
        "params": {"a": 1000.0, "b": "1e3", "c": {"d": True}},
    }


def test_words_for_ros() -> None:
    """Remaps, parameters and the level of the log; what a node here does not know is noted."""
    words = "--ros-args -r a:=b -p rate:=2 --log-level DEBUG --fast yes"
    entries: dict[str, Item] = {}
    noted: list[str] = []
    ros_words(located({"args": words}, HERE), entries, lambda place, text: noted.append(text))
    assert {key: item.plain() for key, item in entries.items()} == {
        "remap": {"a": "b"},
        "params": {"rate": 2},
        "log_level": "debug",
    }
    assert noted == ["args: the node here does not know --fast; it is left out"]
