"""Line breaks for reports: long sentences break between their clauses rather than between any two words."""

from __future__ import annotations

from collections.abc import Sequence

WIDTH = 100
"""Columns of a line of a report, where its names allow that."""
_FURTHER = 4
"""Columns by which the rest of a sentence is indented."""


def filled(indent: str, clauses: Sequence[str]) -> list[str]:
    """Fill lines with clauses; the first line begins with `indent`, the others are indented further."""
    lines = [f"{indent}{clauses[0]}"]
    margin = " " * (len(indent) - len(indent.lstrip()) + _FURTHER)
    for clause in clauses[1:]:
        if len(lines[-1]) + 1 + len(clause) <= WIDTH:
            lines[-1] += f" {clause}"
        else:
            lines.append(f"{margin}{clause.lstrip()}")
    return lines
