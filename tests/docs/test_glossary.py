"""The glossary: every term has a home, and words that it retires are not used as names."""

from __future__ import annotations

import re

import pytest

from tests.conftest import PROJECT

PAGE = (PROJECT / "docs" / "glossary.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| ([\w -]+) \| (.+\.) \| `([\w/.]+)` \|$", PAGE, re.MULTILINE)
RETIRED = {
    *("cellar", "door", "doors", "surroundings", "handover", "rehearsal", "deed", "deeds", "desk", "ink"),
    *("anew", "said", "told"),
}
"""Words that no name of a module, class or function has any more."""
WORDS = re.compile(r"[A-Z]?[a-z]+|[A-Z]+")
FIRST = re.compile(r'"""(What|Those|Whoever|Who|Where|When|How)\b.*')
SOURCES = {p: p.read_text(encoding="utf-8") for p in sorted((PROJECT / "graphflow").rglob("*.py"))}


def test_the_table_is_read() -> None:
    """All of it, in order, and no longer than one reads."""
    lines = [line for line in PAGE.splitlines() if line.startswith("| ")][1:]
    assert len(ROWS) == len(lines) <= 60
    terms = [term.lower() for term, _, _ in ROWS]
    assert terms == sorted(set(terms))


@pytest.mark.parametrize(("term", "home"), [(term, home) for term, _, home in ROWS])
def test_every_term_has_a_home(term: str, home: str) -> None:
    """In a file of the package."""
    assert (PROJECT / "graphflow" / home).is_file(), term


def test_retired_words_are_no_names() -> None:
    """Neither of files nor of what is in them."""
    found = []
    for path, text in SOURCES.items():
        names = re.findall(r"^\s*(?:class|def|async def) (\w+)", text, re.MULTILINE)
        found += [f"{path.name}: {n}" for n in (path.stem, *names) if RETIRED & set(map(str.lower, WORDS.findall(n)))]
    assert not found


def test_docstrings_begin_with_a_noun_or_a_verb() -> None:
    """A question word hides the subject: "Seconds between two pings", not "How often it is pinged"."""
    assert [f"{path.name}: {m[0]}" for path, text in SOURCES.items() for m in FIRST.finditer(text)] == []
