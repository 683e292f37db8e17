r"""The words of a substitution: `$(if $(var sim) 'two words' three)` has `$(var sim)`, `two words` and `three`.

Spaces separate words. A word in single or double quotes may have spaces and parentheses; a backslash escapes any
character, also outside quotes: `\$(var x)` is text, and no substitution.

Source: launch.frontend, the grammar of its substitutions. Unlike there, a quoted word may contain quotes.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import NamedTuple

QUOTES = ("'", '"')
_LITERAL = re.compile(r"""[^\s\\'"()$]+\Z""")
"""A text that needs no quotes as a word."""
_SPECIAL = re.compile(r"""[\s\\'"()$]""")
_VARIABLE = re.compile(r"\$\{ *(\w+) *\}|\$(\w+)|\{\{ *(\w+) *\}\}")
"""A variable as shells and templates write it."""
_QUOTED = {mark: re.compile(rf"{mark}[^{mark}\\]*(?:\\.[^{mark}\\]*)*{mark}", re.DOTALL) for mark in QUOTES}
"""A quoted text, by the kind of quote."""


class Word(NamedTuple):
    """A word of a substitution, without its quotes."""

    text: str
    is_quoted: bool


class UnclosedError(ValueError):
    """A parenthesis or a quote is not closed."""


def spans(text: str, *, is_word: bool = False) -> Iterator[tuple[str, bool]]:
    r"""Split a text into literal parts, without backslashes, and the content of substitutions, marked True.

    Args:
        is_word: Whether the text is a word, in which a backslash escapes any character; elsewhere it does so in `\$(`.

    Raises:
        UnclosedError: A substitution has no closing parenthesis; its argument is the beginning of the substitution.
    """
    literal, i = "", 0
    while i < len(text):
        if text.startswith("$(", i):
            if literal:
                yield literal, False
            end = _closing(text, i)
            yield text[i + 2 : end], True
            literal, i = "", end + 1
        elif text[i] == "\\" and (i + 1 < len(text) if is_word else text.startswith("$(", i + 1)):
            literal, i = literal + text[i + 1], i + 2
        else:
            literal, i = literal + text[i], i + 1
    if literal:
        yield literal, False


def words(text: str) -> list[Word]:
    """Split the content of a substitution into words.

    Raises:
        UnclosedError: A quote is not closed, or text follows it without a space.
    """
    found: list[Word] = []
    i = 0
    while i < len(text):
        if text[i].isspace():
            i += 1
        elif text[i] in QUOTES:
            end = _end_of_quote(text, i)
            if end < 0 or not (end + 1 == len(text) or text[end + 1].isspace()):
                raise UnclosedError(text[i : i + 40])
            found.append(Word(text[i + 1 : end], is_quoted=True))
            i = end + 1
        else:
            begin = i
            while i < len(text) and not text[i].isspace():
                i = _closing(text, i) + 1 if text.startswith("$(", i) else i + (2 if text[i] == "\\" else 1)
            found.append(Word(text[begin:i], is_quoted=False))
    return found


def as_word(text: str) -> str:
    """Quote a text with substitutions as one word of another substitution."""
    try:
        parts = list(spans(text))
    except UnclosedError:  # then there is no substitution in it
        return quoted(text)
    if parts and all(is_inside or _LITERAL.match(part) for part, is_inside in parts):
        return text
    if "\\" not in text and (quote := next((mark for mark in QUOTES if mark not in text), "")):
        return f"{quote}{text}{quote}"
    if not any(is_inside for _, is_inside in parts):
        return quoted("".join(part for part, _ in parts))
    return "".join(f"$({part})" if is_inside else _SPECIAL.sub(r"\\\g<0>", part) for part, is_inside in parts)


def quoted(text: str) -> str:
    """Quote a text without substitutions as one word of a substitution."""
    return text if _LITERAL.match(text) else "'" + re.sub(r"[\\']|\$(?=\()", r"\\\g<0>", text) + "'"


def foreign_variables(text: str, names: Collection[str]) -> Iterator[tuple[str, str]]:
    """Yield names written as variables of other languages, as `${rate}`, each after the text found."""
    for found in _VARIABLE.finditer(text):
        name = next(filter(None, found.groups()))
        if name in names:
            yield found[0], name


def _closing(text: str, start: int) -> int:
    """Return the index of the parenthesis that closes the one at `start + 1`."""
    depth, i = 0, start + 1
    while i < len(text):
        if text[i] == "\\":
            i += 1
        elif text[i] in QUOTES and text[i - 1].isspace() and (end := _end_of_quote(text, i)) > 0:
            i = end
        else:
            depth += {"(": 1, ")": -1}.get(text[i], 0)
            if depth == 0:
                return i
        i += 1
    raise UnclosedError(text[start : start + 40])


def _end_of_quote(text: str, start: int) -> int:
    """Return the index of the quote that closes the one at `start`; -1 if there is none."""
    found = _QUOTED[text[start]].match(text, start)
    return found.end() - 1 if found else -1


def as_argument(name: str, file: str) -> str:
    """Return how a file uses the value of an argument: in Python, or in XML and YAML."""
    return f"LaunchConfiguration({name!r})" if file.endswith(".py") else f"$(var {name})"
