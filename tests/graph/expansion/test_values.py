"""Substitutions and conditions in the blocks of a graph file."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import GraphFileError, Place
from graphflow.graph.checks.validation import Problems
from graphflow.graph.expansion import values as module
from graphflow.graph.expansion.values import Scope, Values
from graphflow.markup.source import Data
from graphflow.markup.substitutions import Outside, Written
from graphflow.markup.tree import Item, located

HERE = Place("g.yaml", 1, 1)
SCOPE = Scope({"x": 2, "sim": True}, (Path("g.yaml"),))


@pytest.fixture
def problems() -> Problems:
    return Problems()


@pytest.fixture
def values(problems: Problems) -> Values:
    return Values(Outside({}), {"g.yaml": Path("g.yaml")}, problems)


def test_an_item(values: Values, problems: Problems) -> None:
    """Substitutions are made in keys and values; words stay texts, and so does what a launch file's argument is."""
    given: Data = {"a$(var x)": "$(var x)", "args": ["$(var x)"]}
    assert values.substituted(located(given, HERE), SCOPE, ("args",)).plain() == {"a2": 2, "args": ["2"]}
    assert values.substituted(Item(Written("$(var x)"), HERE), SCOPE).value == Written("2")
    assert problems == []


@pytest.mark.parametrize(
    ("block", "expected"),
    [
        ({"if": "$(var sim)"}, False),
        ({"unless": "$(var sim)"}, True),
        ({"if": True, "unless": False}, False),
        ({}, False),
    ],
)
def test_conditions(values: Values, block: Data, expected: bool) -> None:
    """A block is left out if any of its conditions says so."""
    assert values.is_left_out(located(block, HERE), SCOPE) is expected


def test_what_cannot_be_made(values: Values, problems: Problems) -> None:
    """It is a problem at its place; the text stays as it is."""
    assert values.made("$(var y)", HERE, SCOPE) == "$(var y)"
    assert not values.is_left_out(located({"if": ["a"]}, HERE), SCOPE)
    assert [str(problem.place) for problem in problems] == ["g.yaml:1:1"]


def test_a_name_as_in_a_shell(values: Values, problems: Problems) -> None:
    """It is text, with a remark."""
    assert values.made("${x}", HERE, SCOPE) == "${x}"
    assert [problem.message for problem in problems.remarks] == [
        "${x} stays as it is; for the value of 'x' write $(var x)"
    ]


def test_the_number_of_values(values: Values, monkeypatch: pytest.MonkeyPatch) -> None:
    """It has a limit."""
    monkeypatch.setattr(module, "MAX_MADE", 3)
    with pytest.raises(GraphFileError, match="more than 3 values"):
        values.substituted(located(["a", "b", "c", "d"], HERE), SCOPE)
