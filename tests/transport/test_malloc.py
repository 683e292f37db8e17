"""What is asked of the C library about freed memory."""

from __future__ import annotations

import ctypes

import pytest

from graphflow.transport.malloc import keep_freed_memory


class Library:
    """A C library that notes what it is asked."""

    def __init__(self) -> None:
        self.asked: list[tuple[int, int]] = []

    def mallopt(self, parameter: int, value: int) -> int:
        self.asked.append((parameter, value))
        return 1


def test_freed_memory_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks up to 32 MB come from the heap (M_MMAP_THRESHOLD), which is cut at 256 MB (M_TRIM_THRESHOLD)."""
    library = Library()
    monkeypatch.setattr(ctypes, "CDLL", lambda name: library)

    keep_freed_memory()

    assert library.asked == [(-3, 32 << 20), (-1, 256 << 20)]


@pytest.mark.parametrize("error", [OSError, AttributeError, TypeError])
def test_another_c_library_is_left_alone(monkeypatch: pytest.MonkeyPatch, error: type[Exception]) -> None:
    """Where there is no glibc nothing is asked, and nothing fails."""

    def missing(name: object) -> object:
        raise error("no such library")

    monkeypatch.setattr(ctypes, "CDLL", missing)

    keep_freed_memory()
