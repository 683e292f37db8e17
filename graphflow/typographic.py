"""Typographic quotes, dashes and spaces, which come with text copied from slides and web pages."""

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
    """Replace typographic characters by those of a keyboard."""
    return text.translate(_PLAIN)


def is_quoted(text: str) -> bool:
    """Return whether a text is in typographic quotes: `“hi”`."""
    return len(text) > 1 and text[0] in _QUOTES and text[-1] in _QUOTES


def option(word: str) -> str:
    """Return the option meant by a word with a typographic dash; empty for any other word, and for numbers.

    Many programs replace two hyphens by one dash; the length of the name decides: `—once` is `--once`, `–r` is `-r`.
    """
    name = word.lstrip("-" + DASHES)
    dashes = word[: len(word) - len(name)]
    if not name[:1].isalpha() or not any(dash in DASHES for dash in dashes):
        return ""
    return f"{'-' if len(name.partition('=')[0]) == 1 else '--'}{name}"
