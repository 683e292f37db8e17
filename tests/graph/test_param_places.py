"""The places of a program's parameters, told through its environment."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.errors import Place
from graphflow.graph.param_places import VARIABLE, place_of, variable
from graphflow.graph.plan import PlannedNode, Setting

HERE = Place("/lab/t.launch.xml", 3, 7)


def planned(executable: str, params: dict[str, Any]) -> PlannedNode:
    settings = {name: Setting(value, HERE) for name, value in params.items()}
    return PlannedNode("/t", "", HERE, HERE, executable=executable, params=settings)


def test_places() -> None:
    """A value that the graph sets has its place; another value under the name, or another name, has none."""
    environment = variable(planned("p talker", {"rate": "fast", "gains": [1, 2.5]}))
    assert place_of("rate", "fast", environment) == "/lab/t.launch.xml:3"
    assert place_of("gains", [1, 2.5], environment) == "/lab/t.launch.xml:3"
    assert place_of("rate", "slow", environment) is None, "it is another program's, started by this one"
    assert place_of("speed", 1, environment) is None
    assert place_of("rate", "fast", {}) is None


def test_nodes_without() -> None:
    """Classes, programs without parameters and very many parameters have no such variable."""
    assert variable(planned("", {"rate": 1.0})) == {}
    assert variable(planned("p talker", {})) == {}
    assert variable(planned("p talker", {f"p{i}": "x" * 100 for i in range(1000)})) == {}


@pytest.mark.parametrize("text", ["", "[]", "3", '{"rate": 1}', '{"rate": [1, 2, 3]}', '{"rate": ["fast", 3]}'])
def test_a_variable_of_others(text: str) -> None:
    """It is ignored."""
    assert place_of("rate", "fast", {VARIABLE: text}) is None
