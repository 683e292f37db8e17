"""Where sentences break."""

from __future__ import annotations

from graphflow.machines.waits.wrapping import WIDTH, filled


def test_what_fits_stays_on_one_line() -> None:
    """Nothing is broken that need not be."""
    assert filled("  ", ["one", "two", "  three"]) == ["  one two   three"]


def test_a_line_breaks_between_clauses_only() -> None:
    """What follows is indented further than the line it belongs to."""
    long = "x" * 60
    assert filled("    -> ", [long, "short", f"  {long}", "end"]) == [f"    -> {long} short", f"        {long} end"]


def test_a_clause_that_is_too_long_stays_whole() -> None:
    """A name cannot be broken."""
    name = "n" * (WIDTH + 5)
    assert filled("", ["it is", name, "there"]) == ["it is", f"    {name}", "    there"]
