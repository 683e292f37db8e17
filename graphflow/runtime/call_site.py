"""Source lines of user code that call the public API."""

from __future__ import annotations

import sys
from pathlib import Path

from graphflow.errors import Place

_PACKAGES = (str(Path(__file__).parent), str(Path(__file__).parents[1] / "testing"))
"""Directories whose frames are skipped: this package and `graphflow.testing`, through which tests call it."""


def here(depth: int = 2) -> Place:
    """Return the line that called the calling function: the first outside this package and `graphflow.testing`."""
    frame = sys._getframe(depth)
    while frame.f_code.co_filename.startswith(_PACKAGES) and frame.f_back is not None:
        frame = frame.f_back
    return Place(frame.f_code.co_filename, frame.f_lineno)
