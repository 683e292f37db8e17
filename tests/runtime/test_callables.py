"""Callables are named and found as far as they are written in Python."""

from __future__ import annotations

import functools
import sys

from graphflow.runtime.callables import code_of, file_of, name_of, written_at


class Tool:
    def use(self) -> None:
        """Do nothing."""

    @classmethod
    def of_class(cls) -> None:
        """Do nothing."""


@functools.cache
def cached() -> None:
    """Do nothing."""


def test_names() -> None:
    """A partial has none."""
    part = functools.partial(print, 1)
    assert [name_of(Tool().use), name_of(print), name_of(part, "task")] == ["use", "print", "task"]
    assert name_of(part) == repr(part)


def test_code() -> None:
    """Of functions and methods, bound or not."""
    assert code_of(Tool().use) is code_of(Tool.use) is Tool.use.__code__
    assert code_of(vars(Tool)["of_class"]) is not None
    assert code_of(print) is None


def test_places() -> None:
    """A decorated function is found where it is written."""
    assert written_at(cached) == f"{__file__}:{cached.__wrapped__.__code__.co_firstlineno}"
    assert written_at(print) == ""


def test_files() -> None:
    """Built-in modules have none."""
    assert [file_of(functools), file_of(sys), file_of(None)] == [functools.__file__, None, None]
