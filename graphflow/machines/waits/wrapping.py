"""Sentences for a terminal: broken between their clauses, where they are too long for a line."""

from __future__ import annotations

from collections.abc import Sequence

WIDTH = 100
"""Columns that a line of a report has at most, where its names allow that."""
_FURTHER = 4
"""Columns by which the rest of a sentence is indented."""


def filled(indent: str, clauses: Sequence[str]) -> list[str]:
    """Clauses as lines, the first after `indent`."""
    lines = [f"{indent}{clauses[0]}"]
    margin = " " * (len(indent) - len(indent.lstrip()) + _FURTHER)
    for clause in clauses[1:]:
        if len(lines[-1]) + 1 + len(clause) <= WIDTH:
            lines[-1] += f" {clause}"
        else:
            lines.append(f"{margin}{clause.lstrip()}")
    return lines
