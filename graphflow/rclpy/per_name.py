"""What is made once for each name, however many threads ask for it at the same time."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import wraps
from typing import TypeVar

T = TypeVar("T")

_LOCK = threading.RLock()
"""One for all, since what is made may need something else of the kind."""


def made_once(make: Callable[[str], T]) -> Callable[[str], T]:
    """Keep what `make` returns. `functools.cache` lets two threads make two, and two classes of one name do not fit."""
    made: dict[str, T] = {}

    @wraps(make)
    def get(name: str) -> T:
        if name not in made:
            with _LOCK:
                if name not in made:
                    made[name] = make(name)
        return made[name]

    return get
