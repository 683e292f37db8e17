"""What ROS's Python packages share: here, what they import before they load libraries of their own."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def add_dll_directories_from_env(env_name: str) -> Iterator[None]:
    """Nothing is loaded, so nothing has to be found."""
    yield
