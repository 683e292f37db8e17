"""Attributes of actions in launch files."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.launchfiles.attributes import children, has_value, output_fault, words
from graphflow.markup import source
from graphflow.markup.tree import Item, tree


def read(text: str) -> Item:
    return tree(source.read(text, "f.yaml"))


def test_children() -> None:
    """A list, or nothing."""
    assert [c.plain() for c in children(read("{children: [1, 2]}\n"))] == [1, 2]
    assert children(read("{children: 3}\n")) == children(read("{a: 1}\n")) == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("'a \"b c\"'", ["a", "b c"]),
        ("[a, 1]", ["a", "1"]),
        ('"a \'b"', ["a", "'b"]),
        ("5", ["5"]),
        ("-d $(var x) --a=$(env HOME)/b", ["-d", "$(var x)", "--a=$(env HOME)/b"]),
        ("$(find-pkg-share $(var p) )/'a b' $(eval '(1)')", ["$(find-pkg-share $(var p) )/a b", "$(eval '(1)')"]),
        ("a $(var x", ["a", "$(var", "x"]),
    ],
)
def test_words(text: str, expected: list[str]) -> None:
    """As a shell splits them; a quote that is not closed is none."""
    assert words(read(f"{{a: {text}}}\n").entries["a"]) == expected
    assert words(None) == []


@pytest.mark.parametrize(("value", "holds"), [("'True'", True), ("true", True), ("'1'", True), ("no", False)])
def test_says(value: Any, holds: bool) -> None:
    """In any case."""
    item = read(f"{{a: {value}}}\n")
    assert has_value(item, "a", "true", "1") is holds
    assert not has_value(item, "b", "true")


@pytest.mark.parametrize("output", ["screen", "own_log", "$(var x)", {"stdout": "screen"}, None])
def test_outputs(output: object) -> None:
    """Of a program, as launch takes them."""
    assert output_fault(output) is None


def test_an_output_that_is_none() -> None:
    """Is told with the one that is meant, or with all."""
    assert output_fault("scren") == "output: 'scren' is not one of launch's; did you mean 'screen'?"
    assert output_fault("x") == "output: 'x' is not one of launch's; there is both, full, log, own_log, screen"
