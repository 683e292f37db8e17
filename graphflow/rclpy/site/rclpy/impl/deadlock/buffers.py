"""Waits for buffers that callbacks fill, such as the transform buffer."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from types import CodeType
from typing import NamedTuple

from graphflow.analysis.frames import Frame
from graphflow.analysis.syntax import syntax_of

_WAITS: dict[CodeType, tuple[str, ...]] = {}


class BufferWait(NamedTuple):
    """A wait until a buffer contains something."""

    buffer: object
    what: str
    """A description of what is awaited."""
    timeout: float
    """The time limit in seconds, from the start of the wait."""
    fillers: tuple[str, ...]
    """The buffer's methods that fill it."""

    def is_filled_by(self, entity: object) -> bool:
        """Whether an entity's callback belongs to a listener that fills the buffer."""
        listener = getattr(getattr(entity, "callback", None), "__self__", None)
        return getattr(listener, "buffer", None) is self.buffer

    def may_be_filled_by(self, files: Iterable[str]) -> bool:
        """Whether code in some files may fill the buffer as well."""
        return any(self._is_named_in(file) for file in files)

    def _is_named_in(self, file: str) -> bool:
        try:
            return any(getattr(node, "attr", "") in self.fillers for node, _ in syntax_of(file).parts)
        except (OSError, SyntaxError, ValueError):  # its source is not available
            return True


def know_buffer(wait: Callable[..., object], *fillers: str) -> None:
    """Register a buffer's method that blocks until the buffer contains something.

    Args:
        wait: A method with an argument `timeout`, a duration; its caller has `target_frame` and `source_frame`.
        fillers: The methods that fill the buffer.
    """
    _WAITS[wait.__code__] = fillers


def buffer_wait(frame: Frame, caller: Frame | None) -> BufferWait | None:
    """Return the wait of a registered method, if this is its frame, and its caller's frame."""
    fillers = _WAITS.get(frame.f_code)
    if fillers is None or caller is None:
        return None
    names, asked = frame.f_locals, caller.f_locals
    what = f"the transform from {asked.get('source_frame')} to {asked.get('target_frame')}"
    return BufferWait(names["self"], what, names["timeout"].nanoseconds / 1e9, fillers)
