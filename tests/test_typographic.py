"""Characters that are pasted from slides."""

from __future__ import annotations

import pytest

from graphflow.typographic import is_quoted, option, plain


def test_those_of_the_keyboard() -> None:
    """Each has one; other characters stay."""
    assert plain("“a” \u2018b\u2019 „c” 1\u20132 —x \u22123\xa0é") == '"a" \'b\' "c" 1-2 -x -3 é'


@pytest.mark.parametrize(
    ("word", "meant"),
    [
        ("—once", "--once"),
        ("\u2013once", "--once"),
        ("\u2013-once", "--once"),
        ("-\u2013once", "--once"),
        ("\u2013r", "-r"),
        ("—r", "-r"),
        ("—rate=3", "--rate=3"),
        ("--once", ""),
        ("-r", ""),
        ("\u20131.5", ""),
        ("—", ""),
        ("hi—there", ""),
        ("", ""),
    ],
)
def test_options(word: str, meant: str) -> None:
    """Those that begin with a dash that is no hyphen, as it may be meant; numbers are none."""
    assert option(word) == meant


def test_quotes_around_a_text() -> None:
    """Not those within it."""
    assert all(map(is_quoted, ["“hi”", "\u2018hi\u2019", "„hi”"]))
    assert not any(map(is_quoted, ["“", "he said “hi”!", '"hi"', ""]))
