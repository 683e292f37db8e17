"""A cache that makes one value per name, even if several threads request it at once."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import wraps
from typing import TypeVar

T = TypeVar("T")

_LOCK = threading.RLock()
"""One lock for all: making a value may require another cached one."""


def made_once(make: Callable[[str], T]) -> Callable[[str], T]:
    """Cache what `make` returns. With `functools.cache`, two threads could make incompatible classes of one name."""
    made: dict[str, T] = {}

    @wraps(make)
    def get(name: str) -> T:
        if name not in made:
            with _LOCK:
                if name not in made:
                    made[name] = make(name)
        return made[name]

    return get
