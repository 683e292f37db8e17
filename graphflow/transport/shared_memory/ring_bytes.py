"""Shared memory as a bytes-like object for decoders. Loads numpy; only types with arrays of numbers use it."""

from __future__ import annotations

import mmap
from collections.abc import Callable
from typing import Any, cast

import numpy as np
from numpy import ndarray


class _RingBytes(ndarray[Any, Any]):
    """Read-only memory whose slices are bytes, and which reports its last use."""

    release: Callable[[], None] | None = None

    def __getitem__(self, key: Any) -> Any:
        found = super().__getitem__(key)
        return found.tobytes() if isinstance(key, slice) else int(found)

    def __bytes__(self) -> bytes:
        return self.tobytes()

    def __del__(self) -> None:
        if self.release is not None:
            self.release()


def ring_bytes(at: mmap.mmap, position: int, size: int, release: Callable[[], None]) -> bytes:
    """Return memory for a decoder; `release` is called when neither it nor an array over it is left."""
    # Not by `view`: arrays over it would refer to the underlying buffer instead, and not keep this object alive.
    found = _RingBytes(size, np.uint8, at, position)
    found.flags.writeable = False
    found.release = release
    return cast("bytes", found)
