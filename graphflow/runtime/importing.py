"""Modules that are imported for the node classes in them: they must not run nodes meanwhile."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from graphflow.analysis.user_code import users_frame
from graphflow.errors import Place, RunsWhenImported

_names: list[str] = []
"""The modules that are being imported, the innermost last."""


@contextmanager
def importing(name: str) -> Iterator[None]:
    """In the block, a module is imported for its classes."""
    _names.append(name)
    try:
        yield
    finally:
        _names.pop()


def refuse_to_run(call: str) -> None:
    """See that nodes are not run by a module that is only imported.

    Args:
        call: What is to run them.

    Raises:
        RunsWhenImported: They are; with the line of the module that does so.
    """
    if not _names:
        return
    frame = users_frame(sys._getframe(1))
    while frame is not None and frame.f_code.co_name != "<module>":  # which may call a `main` that runs them
        frame = users_frame(frame.f_back)
    where = _names[-1] if frame is None else f"{Place(frame.f_code.co_filename, frame.f_lineno)}: this"
    raise RunsWhenImported(f"{where} calls {call} when it is imported; write it below if __name__ == '__main__':")
