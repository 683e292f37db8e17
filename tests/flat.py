"""What a program says, however its lines are broken."""

from __future__ import annotations

import re

_HEAD = re.compile(r"(?m)^\S+ +\| ?")
"""The name of its node before each line of a log."""


def flat(text: str) -> str:
    """A text on one line, with single spaces."""
    return " ".join(_HEAD.sub("", text).split())
