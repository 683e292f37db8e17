"""Lines that YAML does not read as they are meant."""

from __future__ import annotations

import pytest

from graphflow.errors import GraphFileError
from graphflow.markup import source
from graphflow.markup.yaml_slips import as_list, of_key, of_number


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("/a:\n  class: nodes.base: Base", "write class: nodes.base:Base without the space"),
        ("/a: {class: nodes.base: Base}", "write class: nodes.base:Base without the space"),
        (
            "/a: class: nodes.base:Base",
            "write /a: {class: nodes.base:Base}, or class: on a line of its own, indented",
        ),
        ("/a:\n  pkg: p exec: e", "write each key on a line of its own, or {pkg: p, exec: e}"),
        ("a: b: c", "quote a text that has ': ' in it; indent more below a key"),
    ],
)
def test_lines_that_are_refused(text: str, problem: str) -> None:
    """The parser's words are followed by what to write."""
    with pytest.raises(GraphFileError) as caught:
        source.read(text, "f.yaml")
    assert str(caught.value).endswith(f" ({problem})")


@pytest.mark.parametrize("text", ["a: {x: (1.0, 2.0)}", "a: {x: (1.0, 2.0), y: 1}", "a: [b, {x: (1, 2)}]"])
def test_lists_in_parentheses(text: str) -> None:
    """Within braces they would be a text and a key."""
    with pytest.raises(GraphFileError, match=r"f\.yaml:1:\d+: a list is written with brackets: \[1(\.0)?, 2(\.0)?\]$"):
        source.read(text, "f.yaml")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("a: {x: 2.0, 5.0, 8.0}", ["f.yaml:1:13: x: [2.0, 5.0, 8.0]"]),
        ("a: {x: 2, 5, 5, y: -1e3, 9.}", ["f.yaml:1:11: x: [2, 5, 5]", "f.yaml:1:26: y: [-1e3, 9.]"]),
    ],
)
def test_lists_without_brackets(text: str, told: list[str]) -> None:
    """Within braces each number would be a key; each list is told once."""
    found: list[str] = []
    source.read(text, "f.yaml", complain=lambda place, fault: found.append(f"{place}: {fault}"))
    assert [line.replace("a list is written with brackets: ", "") for line in found] == told


def test_numbers_that_are_keys() -> None:
    """They are in no list: they need quotes."""
    with pytest.raises(GraphFileError, match=r"write it in quotes: '5\.0'"):
        source.read("a: {x: 2.0, 5.0: 8.0}", "f.yaml")
    assert of_number("a: {x: 1.0, y: 2.0}", 12) == ""


@pytest.mark.parametrize("text", ["a: {x: (1), y: 2}", "a: {f(x): 1}", "a: {'2)': 1, x: '(1, 2)'}", "a: (1, 2)"])
def test_parentheses_elsewhere(text: str) -> None:
    """They are left alone."""
    source.read(text, "f.yaml")


def test_texts_that_are_meant_as_lists() -> None:
    """Those in parentheses, and numbers with commas."""
    assert as_list("(1.0, 2.0)") == as_list("1.0, 2.0") == "a list is written with brackets: [1.0, 2.0]"
    assert as_list("(a, b)") == "a list is written with brackets: [a, b]"
    assert as_list("a, b") == as_list("1.0") == as_list("[1, 2]") == ""
    assert of_key("2.0)", "x: 2.0)") == ""


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("/a:\n  class:nodes.n:A\n  params:\n    rate: 2.0", "f.yaml:2:3: write a space after 'class:'"),
        ("/a:\n  class:n:A\n\n  # more\n  after:b  # c\n  params: {}", "f.yaml:2:3: write a space after 'class:'"),
        ("- class:n:A\n  params: {}", "f.yaml:1:3: write a space after 'class:'"),
        ("a:1\nb: 2", "f.yaml:1:1: write a space after 'a:'"),
        ("a: http://x\n  b: 2", "f.yaml:2:4: not valid YAML: mapping values are not allowed"),
        ("http://x\nb: 2", "f.yaml:2:2: not valid YAML: mapping values are not allowed"),
        ("class: a:B\n  params: 1", "f.yaml:2:9: not valid YAML: mapping values are not allowed"),
    ],
)
def test_a_key_without_a_space(text: str, told: str) -> None:
    """The parser refuses a later line; the place is that of the mistake."""
    with pytest.raises(GraphFileError) as caught:
        source.read(text, "f.yaml")
    assert str(caught.value).startswith(told)


@pytest.mark.parametrize("text", ["- a:b\n- c: d", "a: b:c\nd: 1", "a:\n  b:c\n", "b:c"])
def test_texts_with_a_colon(text: str) -> None:
    """They are left alone where YAML reads them."""
    source.read(text, "f.yaml")
