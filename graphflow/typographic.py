"""Quotes, dashes and spaces as slides and web pages have them: they look like those of a keyboard, and are others."""

from __future__ import annotations

DASHES = "\N{HYPHEN}\N{NON-BREAKING HYPHEN}\N{FIGURE DASH}\N{EN DASH}\N{EM DASH}\N{HORIZONTAL BAR}\N{MINUS SIGN}"
_QUOTES = {
    "\N{LEFT DOUBLE QUOTATION MARK}": '"',
    "\N{RIGHT DOUBLE QUOTATION MARK}": '"',
    "\N{DOUBLE LOW-9 QUOTATION MARK}": '"',
    "\N{LEFT SINGLE QUOTATION MARK}": "'",
    "\N{RIGHT SINGLE QUOTATION MARK}": "'",
    "\N{SINGLE LOW-9 QUOTATION MARK}": "'",
}
_PLAIN = str.maketrans({**_QUOTES, **dict.fromkeys(DASHES, "-"), "\N{NO-BREAK SPACE}": " "})


def plain(text: str) -> str:
    """A text with the characters of a keyboard."""
    return text.translate(_PLAIN)


def is_quoted(text: str) -> bool:
    """Whether a text stands in quotes that are none: `“hi”`."""
    return len(text) > 1 and text[0] in _QUOTES and text[-1] in _QUOTES


def option(word: str) -> str:
    """The option that a word is meant as which begins with such a dash; empty for any other word, and for numbers.

    One that stands for two hyphens, as many programs write it, is told by the name behind it: `—once`, `–r`.
    """
    name = word.lstrip("-" + DASHES)
    dashes = word[: len(word) - len(name)]
    if not name[:1].isalpha() or not any(dash in DASHES for dash in dashes):
        return ""
    return f"{'-' if len(name.partition('=')[0]) == 1 else '--'}{name}"
