"""The words of a substitution, and texts as words."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from graphflow.markup.substitution_words import UnclosedError, Word, as_word, foreign_variables, quoted, spans, words
from tests.cases import count


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", []),
        ("a  b", ["a", "b"]),
        ("'a b' \"c d\" ''", ["a b", "c d", ""]),
        ("$(var a) x$(env B 'c d')y", ["$(var a)", "x$(env B 'c d')y"]),
        (r"'it\'s' a\ b", [r"it\'s", r"a\ b"]),
        ("it's", ["it's"]),
        ("'$(var a) b'", ["$(var a) b"]),
    ],
)
def test_words(text: str, expected: list[str]) -> None:
    """Spaces part them, but not within quotes and substitutions."""
    assert [word.text for word in words(text)] == expected


@pytest.mark.parametrize("text", ["'a", "'a'b", "\"a'", "a $(b"])
def test_words_that_do_not_end(text: str) -> None:
    """A quote belongs to a word as a whole."""
    with pytest.raises(UnclosedError):
        words(text)


def test_spans() -> None:
    """A backslash stands for itself in a text, except before a substitution; in a word it takes any meaning away."""
    assert list(spans(r"a\b \$(c) $(d (e) ')')f")) == [(r"a\b $(c) ", False), ("d (e) ')'", True), ("f", False)]
    assert list(spans(r"a\b\\ \$(c)", is_word=True)) == [(r"ab\ $(c)", False)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "''"),
        ("a$(var b c)", "a$(var b c)"),
        ("a $(var b)", "'a $(var b)'"),
        ("'$(var b)'", "\"'$(var b)'\""),
        ("""it's "$(var b 'c')" """, r"""it\'s\ \"$(var b 'c')\"\ """),
        ("no $(end", r"'no \$(end'"),
    ],
)
def test_a_text_as_a_word(text: str, expected: str) -> None:
    """With quotes where it needs them, and with backslashes where those do not do."""
    assert as_word(text) == expected


@settings(derandomize=True, max_examples=count(few=75, full=300), deadline=None)
@given(st.text("a '\"\\$()\n", max_size=12))
def test_a_quoted_text_is_read_back(text: str) -> None:
    """As the one word that it is, whatever is in it."""
    [word] = words(quoted(text))
    assert "".join(part for part, _ in spans(word.text, is_word=True)) == text
    assert words(f"a {quoted(text)} b")[1] == word
    assert isinstance(word, Word)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("${rate} Hz", [("${rate}", "rate")]),
        ("$rate,{{ who }}", [("$rate", "rate"), ("{{ who }}", "who")]),
        ("$(var rate) $rates ${HOME} rate {who}", []),
    ],
)
def test_variables_of_other_languages(text: str, found: list[tuple[str, str]]) -> None:
    """Are told if they are names that are known here."""
    assert list(foreign_variables(text, ["rate", "who"])) == found
