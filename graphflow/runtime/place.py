"""The user's line that has called into this package."""

from __future__ import annotations

import sys
from pathlib import Path

from graphflow.errors import Place

_PACKAGE = str(Path(__file__).parent)


def here(depth: int = 2) -> Place:
    """The line that called the calling function; the first outside of this package."""
    frame = sys._getframe(depth)
    while frame.f_code.co_filename.startswith(_PACKAGE) and frame.f_back is not None:
        frame = frame.f_back
    return Place(frame.f_code.co_filename, frame.f_lineno)
