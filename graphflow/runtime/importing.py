"""Guard against modules that run nodes while they are imported for their node classes."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from graphflow.analysis.user_code import users_frame
from graphflow.errors import Place, RunsWhenImported

_names: list[str] = []
"""Names of the modules being imported, innermost last."""


@contextmanager
def importing(name: str) -> Iterator[None]:
    """Mark a module as being imported for its classes, for the length of the block."""
    _names.append(name)
    try:
        yield
    finally:
        _names.pop()


def refuse_to_run(call: str) -> None:
    """Refuse to run nodes while a module is imported for its classes.

    Args:
        call: The call that would run them.

    Raises:
        RunsWhenImported: A module is being imported; the text has its line that runs nodes.
    """
    if not _names:
        return
    frame = users_frame(sys._getframe(1))
    while frame is not None and frame.f_code.co_name != "<module>":  # the module may call a `main` that runs them
        frame = users_frame(frame.f_back)
    where = _names[-1] if frame is None else f"{Place(frame.f_code.co_filename, frame.f_lineno)}: this"
    raise RunsWhenImported(f"{where} calls {call} when it is imported; write it below if __name__ == '__main__':")
