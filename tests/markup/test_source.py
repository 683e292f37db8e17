"""YAML as plain values with places: what is read as what, and what is refused where."""

from __future__ import annotations

import json
import math
import os
import re
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from graphflow.errors import GraphFileError, GraphflowError, Place
from graphflow.markup import source
from graphflow.markup.source import MAX_BYTES, MAX_DEPTH, MAX_VALUES, parse_value, read, read_file, scalar
from graphflow.markup.tree import tree
from tests.cases import count, slow


def refused(text: str) -> str:
    """The one problem of a text, as `line:column: message`."""
    with pytest.raises(GraphFileError) as caught:
        read(text, "f.yaml")
    (problem,) = caught.value.problems
    return str(problem).removeprefix("f.yaml:")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("200", 200),
        ("-7", -7),
        ("+7", 7),
        ("017", 17),
        ("0o17", 15),
        ("0xfF", 255),
        ("1.5", 1.5),
        ("1.", 1.0),
        (".5", 0.5),
        ("1e3", 1000.0),
        ("-1.5E-3", -0.0015),
        (".inf", math.inf),
        ("-.INF", -math.inf),
        ("true", True),
        ("False", False),
        ("null", None),
        ("~", None),
        ("", None),
        ("on", "on"),
        ("no", "no"),
        ("yes", "yes"),
        ("y", "y"),
        ("12:30:45", "12:30:45"),
        ("1_000", "1_000"),
        ("2024-01-01", "2024-01-01"),
        ("0b11", "0b11"),
        ("0o8", "0o8"),
        ("1e", "1e"),
        (".", "."),
        ("-", "-"),
        ("1.2.3", "1.2.3"),
        ("tRue", "tRue"),
        ("/turtle1/pose", "/turtle1/pose"),
        ("nodes.talker:Talker", "nodes.talker:Talker"),
        ("$(var x)", "$(var x)"),
        ("=", "="),
        ("<<", "<<"),
    ],
)
def test_scalars_are_those_of_yaml_1_2(text: str, value: Any) -> None:
    """The core schema decides what is a number, a bool or nothing; all else is text."""
    found = scalar(text)
    assert (found, type(found)) == (value, type(value))
    if text not in ("-", ""):
        assert read(f"a: {text}", "f.yaml").data == {"a": value}


def test_line_breaks_of_other_systems() -> None:
    """Keys have their places, and their faults are found, whatever ends a line."""
    src = read("a: 1\rb: 2\r\nc: 3\n", "f.yaml")
    assert src.data == {"a": 1, "b": 2, "c": 3}
    assert src.key_place(("c",)) == Place("f.yaml", 3, 1)


def test_not_a_number() -> None:
    """`.nan` is the float that is not itself."""
    value = scalar(".nan")
    assert isinstance(value, float)
    assert math.isnan(value)


@pytest.mark.parametrize("text", ["'1'", '"true"', "''", "|\n  12\n", '"\\u00e9"', "!!str 12", "! 12"])
def test_what_is_quoted_is_text(text: str) -> None:
    """Quotes, block style and `!!str` keep a scalar from being anything else."""
    assert isinstance(tree(read(f"a: {text}", "f.yaml")).entries["a"].value, str)


def test_every_value_and_key_knows_its_place() -> None:
    """Lines and columns count from 1; a list element is addressed by its index."""
    src = read("nodes:\n  /a:\n    after: [x, {y: 3}]\n", "f.yaml")
    assert src.data == {"nodes": {"/a": {"after": ["x", {"y": 3}]}}}
    assert src.places == {
        (): Place("f.yaml", 1, 1),
        ("nodes",): Place("f.yaml", 2, 3),
        ("nodes", "/a"): Place("f.yaml", 3, 5),
        ("nodes", "/a", "after"): Place("f.yaml", 3, 12),
        ("nodes", "/a", "after", 0): Place("f.yaml", 3, 13),
        ("nodes", "/a", "after", 1): Place("f.yaml", 3, 16),
        ("nodes", "/a", "after", 1, "y"): Place("f.yaml", 3, 20),
    }
    assert src.keys == {
        ("nodes",): Place("f.yaml", 1, 1),
        ("nodes", "/a"): Place("f.yaml", 2, 3),
        ("nodes", "/a", "after"): Place("f.yaml", 3, 5),
        ("nodes", "/a", "after", 1, "y"): Place("f.yaml", 3, 17),
    }


def test_the_place_of_what_is_not_there() -> None:
    """Something that was not written is where the nearest thing above it is."""
    src = read("a:\n  b: 1\n", "f.yaml")
    assert src.place(("a", "c", "d")) == Place("f.yaml", 2, 3)
    assert src.key_place(("a", "c")) == Place("f.yaml", 2, 3)
    assert src.place(("z",)) == Place("f.yaml", 1, 1)
    assert src.key_place(("a", "b")) == Place("f.yaml", 2, 3)


@pytest.mark.parametrize("text", ["", "\n\n", "# only a comment\n", "---\n"])
def test_an_empty_file_is_nothing(text: str) -> None:
    """A file without values reads as None, and has a place."""
    src = read(text, "f.yaml")
    assert src.data is None
    assert src.file == "f.yaml"


@pytest.mark.parametrize(("text", "value"), [("- a\n- 1\n", ["a", 1]), ("just words", "just words"), ("[]", [])])
def test_the_top_may_be_anything(text: str, value: Any) -> None:
    """Values from the command line are read here, too: a document is a mapping, a list or a scalar."""
    assert read(text, "f.yaml").data == value


BOMB = "\n".join(
    ["a0: &a0 [lol, lol]", *(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 10)), "nodes: *a9"]
)
NESTED = 900
"""Fewer than libyaml takes."""


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (BOMB, "2:10: *a0: aliases are not used here; write the value out"),
        ("a: &x [*x]", "1:8: *x: aliases are not used here; write the value out"),
        ("*x : 1", "1:1: *x: aliases are not used here; write the value out"),
        (
            "nodes: !!python/object/apply:os.system [ls]",
            "1:8: !!python/object/apply:os.system: tags are not used here; write a plain value",
        ),
        ("a: !vehicle {b: 1}", "1:4: !vehicle: tags are not used here; write a plain value"),
        ("a:\n - !!int 3", "2:4: !!int: tags are not used here; write a plain value"),
        ("!!str a: 1\n!!set b: 2", "2:1: !!set: tags are not used here; write a plain value"),
        ("[" * NESTED + "]" * NESTED, f"1:{MAX_DEPTH + 1}: nested more than {MAX_DEPTH} deep"),
        ("a: " + "{a: " * NESTED + "}" * NESTED, f"1:{4 * MAX_DEPTH}: nested more than {MAX_DEPTH} deep"),
        ("\n".join("- 1" for _ in range(MAX_VALUES)), f"{MAX_VALUES}:3: the file has more than 50,000 values"),
        ("a: 1\nb: 2\na: 3", "3:1: the key 'a' appears twice, first on line 1; remove one"),
        (
            "nodes:\n  /a: {x: 1}\n  /a: {x: 2}",
            "3:3: the key '/a' appears twice, first on line 2; for two nodes, give one another name, such as /a2; else "
            "remove one",
        ),
        ("x: {a: 1, 'a': 2}", "1:11: the key 'a' appears twice, first on line 1; remove one"),
        ("1: a", "1:1: the key 1 is not text; write it in quotes: '1'"),
        ("x:\n  true: a", "2:3: the key true is not text; write it in quotes: 'true'"),
        ("~: a", "1:1: the key ~ is not text; write it in quotes: '~'"),
        ("1.5: a", "1:1: the key 1.5 is not text; write it in quotes: '1.5'"),
        ("{255, 0, 0}", "1:2: values have names: {name: 255, ...}"),
        ("{x: 2,0}", "1:7: a number is written with a point: 2.0, not 2,0"),
        ("{x: [1], 2: 3}", "1:10: the key 2 is not text; write it in quotes: '2'"),
        ("{x: a1,2: 3}", "1:8: the key 2 is not text; write it in quotes: '2'"),
        ("? [a]\n: 1", "1:3: a key must be a word, not a list or mapping"),
        ("{a: 1}: 1", "1:1: a key must be a word, not a list or mapping"),
        (f"a: {'9' * 5000}", f"1:4: {'9' * 20}... has too many digits for a number; put text in quotes"),
        (f"{'9' * 5000}: a", f"1:1: {'9' * 20}... has too many digits for a number; put text in quotes"),
        ("a: 1\n---\nb: 2", "2:1: one document per file: remove the line '---'"),
        ("a: 1\nb: x\0y", "2:5: the character U+0000 is not allowed in a YAML file; delete it"),
        ("\x1b[0m", "1:1: the character U+001B is not allowed in a YAML file; delete it"),
        ("a: \ud800", "1:4: the character U+D800 is not allowed in a YAML file; delete it"),
    ],
    ids=lambda text: repr(text[:30]),
)
def test_what_is_unsafe_or_ambiguous_is_refused(text: str, problem: str) -> None:
    """Aliases, tags, depth, size, twice the same key, keys that are no text: refused at the place they stand."""
    assert refused(text) == problem


def test_what_is_nested_deeper_than_libyaml_takes() -> None:
    """It reads ahead and, since 0.2.6, refuses that itself: at another place."""
    assert refused("[" * 5000 + "]" * 5000).endswith(f": nested more than {MAX_DEPTH} deep")


@pytest.mark.parametrize(
    ("text", "place", "help_"),
    [
        ("nodes:\n\t/a: 1", "2:1", "(indent with spaces, not tabs)"),
        ("a:\n  b: 1\n\tc: 2", "3:1", "(indent with spaces, not tabs)"),
        ("a: {b: 1", "1:9", "(the { in line 1, column 4 is not closed, or a text after it needs quotes)"),
        ("a: [b, c\nd: 1", "2:2", "(the [ in line 1, column 4 is not closed, or a text after it needs quotes)"),
        ("x: 1\na: {b: c: d}", "2:9", "(the { in line 2, column 4 is not closed, or a text after it needs quotes)"),
        ('a: "b', "1:6", "(the quote in line 1, column 4 is not closed)"),
        ("a: b: c", "1:5", "(quote a text that has ': ' in it; indent more below a key)"),
        ("a: 'it's me'", "1:8", "(an apostrophe in quotes is written twice: 'it''s')"),
        ("x: 1\na: {b: 'it's'}", "2:12", "(an apostrophe in quotes is written twice: 'it''s')"),
        ("a: @b", "1:4", "(quote a text that begins with @)"),
        ("a: 50\nb: %", "2:4", "(quote a text that begins with %)"),
        ("a: {b: ${var x}}", "1:9", "(a substitution is written with parentheses, as in $(var x))"),
        ("a:\n    b: 1\n  c: 2", "3:3", "(indent the keys of one mapping with the same number of spaces)"),
    ],
)
def test_what_is_no_yaml_says_what_to_do(text: str, place: str, help_: str) -> None:
    """The parser's complaint comes with its place, and with the likely cure."""
    found = refused(text)
    assert found.startswith(f"{place}: not valid YAML: ")
    assert found.endswith(help_)


@pytest.mark.parametrize("text", ["&a", "a: b\n...\n%", "!<", "a: !!", "'", "a\n: b", "%YAML 3.0\n---\n", "["])
def test_half_a_construct_has_a_place(text: str) -> None:
    """What ends too early is one problem with line and column, or it is a value."""
    with suppress(GraphFileError):
        read(text, "f.yaml")
        return
    assert re.match(r"\d+:\d+: ", refused(text))


def test_the_limits() -> None:
    """What a person writes is far below, and what would hurt is far above."""
    assert (MAX_BYTES, MAX_DEPTH, MAX_VALUES) == (1_000_000, 40, 50_000)


def test_a_large_file_is_refused_unread() -> None:
    """Size is looked at first, in bytes."""
    assert refused("é" * (MAX_BYTES // 2 + 1)) == " the file is larger than 1,000,000 bytes"


def test_the_largest_number() -> None:
    """Python's limit on digits is no matter below it."""
    assert read(f"a: {'9' * 4000}", "f.yaml").data == {"a": 10**4000 - 1}


def test_files_are_utf8_text(tmp_path: Path) -> None:
    """A byte order mark is no part of a file; another encoding, or no file, is a problem with a place."""
    file = tmp_path / "f.yaml"
    file.write_bytes(b"\xef\xbb\xbfa: \xc3\xa9\n")
    found = read_file(file, "f.yaml")
    assert (found.data, found.keys[("a",)]) == ({"a": "é"}, Place("f.yaml", 1, 1))
    for data, line in ((b"a: 1\nb: \xe9\n", 2), ("a: 1".encode("utf-16"), 1), (b"\xff\xfe", 1)):
        file.write_bytes(data)
        with pytest.raises(GraphFileError) as caught:
            read_file(file, "f.yaml")
        assert str(caught.value) == f"f.yaml:{line}: is not UTF-8 text; save the file as UTF-8"
    with pytest.raises(GraphFileError, match=r"none\.yaml: cannot be read: No such file"):
        read_file(tmp_path / "none.yaml", "none.yaml")
    with pytest.raises(GraphFileError, match="cannot be read: Is a directory"):
        read_file(tmp_path, "folder")


def test_files_of_other_kinds(tmp_path: Path) -> None:
    """A FIFO without a writer keeps nobody waiting; a file without an end is left."""
    os.mkfifo(tmp_path / "fifo.yaml")
    with pytest.raises(GraphFileError, match=r"p\.yaml: cannot be read: it is not a regular file"):
        read_file(tmp_path / "fifo.yaml", "p.yaml")
    (tmp_path / "long.yaml").write_bytes(b"#" * (MAX_BYTES + 1))
    with pytest.raises(GraphFileError, match=r"cannot be read: it has more than 1,000,000 bytes"):
        read_file(tmp_path / "long.yaml", "p.yaml")


@pytest.mark.parametrize(
    ("text", "value"), [("200", 200), ("{x: 1.0}", {"x": 1.0}), ("on", "on"), ("[1, 2]", [1, 2]), ("", None)]
)
def test_values_from_the_command_line(text: str, value: Any) -> None:
    """A word of the command line is a YAML document of its own."""
    assert parse_value(text) == value


def test_a_wrong_value_names_the_character() -> None:
    """There is no file to point into: the text itself is shown, with the character."""
    with pytest.raises(GraphflowError, match=r"^'\{x: 1', character 6: not valid YAML: .* is not closed") as caught:
        parse_value("{x: 1")
    assert not isinstance(caught.value, GraphFileError)


# JSON writes characters beyond U+FFFF as two escapes, which are no characters for YAML.
TEXTS = st.text(st.characters(max_codepoint=0xFFFF, exclude_categories=["Cs"]))
KEYS = st.text(st.characters(max_codepoint=0xFFFF, exclude_categories=["Cs"]), max_size=100)
"""YAML ends the search for a key's colon after 1024 characters."""
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | TEXTS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(KEYS, inner, max_size=4),
    max_leaves=20,
)


@slow
@settings(derandomize=True, max_examples=count(few=37, full=150), deadline=None)
@given(VALUES)
def test_json_is_yaml(value: Any) -> None:
    """What JSON can write, the reader reads as the same data."""
    assert read(json.dumps(value), "f.yaml").data == json.loads(json.dumps(value))


@settings(derandomize=True, max_examples=count(few=75, full=300), deadline=None)
@given(st.text(alphabet="ab01.:-,#&*!|>%@'\"{}[]?~ \n\t$()é\0", max_size=40))
def test_no_text_breaks_the_reader(text: str) -> None:
    """Any text is data or a GraphFileError, and every value and key of the data has a place."""
    try:
        src = read(text, "f.yaml")
    except GraphFileError:
        return

    def walk(value: Any, path: source.Path) -> None:
        assert path in src.places
        for key, item in value.items() if isinstance(value, dict) else ():
            assert (*path, key) in src.keys
            walk(item, (*path, key))
        for i, item in enumerate(value if isinstance(value, list) else ()):
            walk(item, (*path, i))

    walk(src.data, ())


@settings(derandomize=True, max_examples=60, deadline=None)
@given(st.text(alphabet="ab01.:-,#&*!|>%@'\"{}[]?~ \n$", max_size=30))
def test_both_parsers_agree(text: str) -> None:
    """Where libyaml is missing, PyYAML's own parser reads the same values at the same places."""

    def outcome() -> object:
        try:
            src = read(text, "f.yaml")
            return src.data, src.places
        except GraphFileError:
            return "refused"

    fast = outcome()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(source, "_LOADER", yaml.SafeLoader)
        slow = outcome()
    # libyaml takes a few texts that PyYAML refuses; what both take is the same.
    assert "refused" in (fast, slow) or repr(fast) == repr(slow)


def test_keys_that_are_no_text_can_be_told_together(tmp_path: Path) -> None:
    """With somebody to tell, they are left out with what is below them, and the rest of the file is read."""
    (tmp_path / "f.yaml").write_text("a: {x: 2,0, y: 1}\n3: {z: [4]}\n")
    told: list[str] = []

    found = read_file(tmp_path / "f.yaml", "f.yaml", complain=lambda place, text: told.append(f"{place}: {text}"))

    assert found.data == {"a": {"x": 2, "y": 1}}
    assert told == [
        "f.yaml:1:10: a number is written with a point: 2.0, not 2,0",
        "f.yaml:2:1: the key 3 is not text; write it in quotes: '3'",
    ]


QUOTES = "f.yaml:1:{}: {} and {} are not quotes in YAML, and are part of the value; write {}, or '{}' to keep them"
DOUBLE, SINGLE = "\u201chello\u201d", "\u2018hello\u2019"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (f"a: {{b: {DOUBLE}}}", QUOTES.format(8, "\u201c", "\u201d", '"hello"', DOUBLE)),
        (f"- {SINGLE}", QUOTES.format(3, "\u2018", "\u2019", "'hello'", SINGLE)),
        (f"a: '{DOUBLE}'", ""),
        (f'a: "{DOUBLE}"', ""),
        (f"a: |-\n  {DOUBLE}", ""),
        (f"a: {DOUBLE} or {DOUBLE}", ""),
        (f"a: he said {DOUBLE}", ""),
        ("a: \u201d", ""),
    ],
)
def test_typographic_quotes(text: str, told: str) -> None:
    """A value in nothing but such quotes gets a remark, unless YAML's own are around them; the value stays."""
    found: list[str] = []
    data = read(text, "f.yaml", remark=lambda place, message: found.append(f"{place}: {message}")).data
    assert found == ([told] if told else [])
    assert data == read(text, "f.yaml").data
