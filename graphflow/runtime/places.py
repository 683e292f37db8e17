"""Which code is the user's own: what errors and reports point at."""

from __future__ import annotations

import sysconfig
from pathlib import Path

_OURS = str(Path(__file__).parents[1])
_PYTHONS = sysconfig.get_path("stdlib")


def is_users(file: str) -> bool:
    """Whether a source file is neither graphflow's nor Python's own."""
    if file.startswith((_OURS, "<frozen")):
        return False
    return not file.startswith(_PYTHONS) or "site-packages" in file
