"""Where users have written what this room is called with."""

from __future__ import annotations

import sys
from pathlib import Path

from graphflow.errors import Place

_ROOM = str(Path(__file__).parent)


def here(depth: int = 2) -> Place:
    """Where the calling function was called, or what called that, as far as it is of this room."""
    frame = sys._getframe(depth)
    while frame.f_code.co_filename.startswith(_ROOM) and frame.f_back is not None:
        frame = frame.f_back
    return Place(frame.f_code.co_filename, frame.f_lineno)
