"""The arguments of a graph: whence their values come, and which they may be."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.graph.checks.validation import Problems
from graphflow.graph.expansion.arguments import Arguments
from graphflow.markup import source
from graphflow.markup.tree import tree


def values(declared: str, *given: str, outer: dict[str, Any] | None = None, fixed: str = "{}") -> Any:
    """What a file's arguments are, or what is wrong with them."""
    problems = Problems()
    arguments = Arguments(given, problems)
    items = tree(source.read(declared, "f.yaml")), tree(source.read(fixed, "over.yaml"))
    found = arguments.of_file(items[0], outer or {}, items[1].entries)
    arguments.refuse_strays()
    return [str(problem) for problem in problems] or found


@pytest.mark.parametrize(
    ("declared", "given", "found"),
    [
        ("{a: {default: 1}}", [], {"a": 1}),
        ("{a: {default: 1}}", ["a:=2.5"], {"a": 2.5}),
        ("{a: {default: 1, type: float}}", [], {"a": 1.0}),
        ("{a: {type: list}}", ["a:=[1, x]"], {"a": [1, "x"]}),
        ("{a: {type: str}}", ["a:=007"], {"a": "007"}),
        ("{a: {default: x}}", ["a:=true"], {"a": "true"}),
        ("{a: {default: false}}", ["a:=true"], {"a": True}),
        ("{a: {}}", ["a:=true"], {"a": True}),
        ("{a: {choices: [1, 2]}}", ["a:=2"], {"a": 2}),
    ],
)
def test_values(declared: str, given: list[str], found: dict[str, Any]) -> None:
    """From the command line before the default, as the type that is declared or that the default has."""
    got = values(declared, *given)
    assert got == found
    assert [type(value) for value in got.values()] == [type(value) for value in found.values()]


@pytest.mark.parametrize(
    ("declared", "given", "problem"),
    [
        ("{a: {type: int}}", "a:=2.5", "command line: argument 'a': expected a whole number, got 2.5"),
        ("{a: {type: int}}", "a:=true", "command line: argument 'a': expected a whole number, got True"),
        ("{a: {type: bool}}", "a:=yes", "command line: argument 'a': expected true or false, got 'yes'"),
        ("{a: {type: float, default: x}}", "a:=1", ""),
        ("{a: {default: 0.8}}", "a:=fast", "argument 'a': expected a number, as its default 0.8 is, got 'fast'"),
        ("{a: {default: true}}", "a:=1", "argument 'a': expected true or false, as its default true is, got 1"),
        ("{a: {choices: [x, y]}}", "a:=z", "f.yaml:1:2: argument 'a' is 'z', but must be one of x, y"),
        ("{a: {default: 1}}", "b:=1", "command line: there is no argument 'b'; there is a"),
        ("{}", "b:=1", "command line: there is no argument 'b'; the file declares none"),
        ("{a: {}}", "a=1", "command line: 'a=1': an argument is written name:=value; write a:=1"),
    ],
)
def test_what_they_may_not_be(declared: str, given: str, problem: str) -> None:
    """Each mistake says what was expected."""
    got = values(declared, given)
    assert any(problem in text for text in got) if problem else got == {"a": 1.0}


@pytest.mark.parametrize("words", ["a:= 1", "a := 1", "a :=1", "a: 1", "a = 1", "a=1", "a:1"])
def test_an_argument_with_a_slip(words: str) -> None:
    """Is answered once, with the argument to write."""
    problems = Problems()
    arguments = Arguments([*words.split(), "b:=2", "c:="], problems)
    assert [str(one) for one in problems] == [
        f"command line: {words!r}: an argument is written name:=value; write a:=1"
    ]
    assert arguments._given.get("a") in (None, "1")  # not an empty value, which would be another mistake


def test_words_that_are_no_argument() -> None:
    """Are told one by one; an empty value takes nothing of the argument behind it."""
    problems = Problems()
    Arguments(["a:=", "b:=2", ":=1", "fast", "c:=x y"], problems)
    assert [str(one) for one in problems] == [
        f"command line: {word!r}: an argument is written name:=value" for word in (":=1", "fast")
    ]


def test_a_default_of_another_type() -> None:
    """It is told where it was written."""
    assert values("{a: {type: int, default: x}}") == ["f.yaml:1:26: argument 'a': expected a whole number, got 'x'"]


def test_files_that_are_included() -> None:
    """What the including file gives is fixed; what holds there comes before the included file's default."""
    assert values("{a: {default: 1}, b: {default: 2}}", outer={"a": 7}, fixed="{b: 8}") == {"a": 7, "b": 8}
    [problem] = values("{a: {default: 1}}", "a:=3", fixed="{a: 8}")
    assert problem.startswith("command line: there is no argument 'a'; the file declares none")
    assert values("{gain: {default: 1}}", fixed="{gian: 8}") == [
        "over.yaml:1:2: the included file has no argument 'gian'; did you mean 'gain'?"
    ]
    assert values("{a: {type: int, default: 1}}", fixed="{a: x}") == [
        "over.yaml:1:5: argument 'a': expected a whole number, got 'x'"
    ]
