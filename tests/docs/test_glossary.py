"""The glossary: every term has a home, and words that it retires are not used as names."""

from __future__ import annotations

import re

import pytest

from tests.conftest import PROJECT

PAGE = (PROJECT / "docs" / "glossary.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| ([\w -]+) \| (.+\.) \| `([\w/.]+)` \|$", PAGE, re.MULTILINE)
RETIRED = ("cellar", "doors", "surroundings", "handover", "rehearsal")
"""Words that no module, class or function may have in its name any more."""


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
    for path in (PROJECT / "graphflow").rglob("*.py"):
        names = re.findall(r"^\s*(?:class|def|async def) (\w+)", path.read_text(encoding="utf-8"), re.MULTILINE)
        found += [f"{path.name}: {n}" for n in (path.stem, *names) for word in RETIRED if word in n.lower()]
    assert not found
