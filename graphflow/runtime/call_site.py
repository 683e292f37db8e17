"""The user's line that has called into this package."""

from __future__ import annotations

import sys
from pathlib import Path

from graphflow.errors import Place

_PACKAGES = (str(Path(__file__).parent), str(Path(__file__).parents[1] / "testing"))
"""This package, and the one by which tests call it."""


def here(depth: int = 2) -> Place:
    """The line that called the calling function; the first outside of this package and of that for tests."""
    frame = sys._getframe(depth)
    while frame.f_code.co_filename.startswith(_PACKAGES) and frame.f_back is not None:
        frame = frame.f_back
    return Place(frame.f_code.co_filename, frame.f_lineno)
