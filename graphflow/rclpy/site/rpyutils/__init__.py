"""The function of rpyutils that ROS packages call before they load shared libraries."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def add_dll_directories_from_env(env_name: str) -> Iterator[None]:
    """Do nothing: no library is loaded."""
    yield
