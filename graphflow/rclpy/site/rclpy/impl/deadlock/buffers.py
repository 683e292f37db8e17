"""Buffers that callbacks fill, such as that of transforms, and code that blocks until something is in one."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from types import CodeType
from typing import Any, NamedTuple

from graphflow.analysis.frames import Frame
from graphflow.analysis.syntax import syntax_of

_WAITS: dict[CodeType, tuple[str, ...]] = {}


class BufferWait(NamedTuple):
    """A wait until something is in a buffer."""

    buffer: Any
    what: str
    """The awaited thing, in words."""
    timeout: float
    """Seconds until it gives up, from when it began."""
    fillers: tuple[str, ...]
    """The methods of the buffer that fill it."""

    def is_filled_by(self, entity: object) -> bool:
        """Whether an entity's callback is that of a listener, which fills the buffer."""
        listener = getattr(getattr(entity, "callback", None), "__self__", None)
        return getattr(listener, "buffer", None) is self.buffer

    def may_be_filled_by(self, files: Iterable[str]) -> bool:
        """Whether the code of some files may fill it, too."""
        return any(self._is_named_in(file) for file in files)

    def _is_named_in(self, file: str) -> bool:
        try:
            return any(getattr(node, "attr", "") in self.fillers for node, _ in syntax_of(file).parts)
        except (OSError, SyntaxError, ValueError):  # no source to be read: who knows
            return True


def know_buffer(wait: Callable[..., Any], *fillers: str) -> None:
    """Have a method of a buffer taken for one that blocks until something is in it.

    Args:
        wait: Has `timeout`, a duration, among its arguments. Its caller's are `target_frame` and `source_frame`.
        fillers: The methods that fill the buffer.
    """
    _WAITS[wait.__code__] = fillers


def buffer_wait(frame: Frame, caller: Frame | None) -> BufferWait | None:
    """The wait of such a method, if this is the frame of one, and that of its caller."""
    fillers = _WAITS.get(frame.f_code)
    if fillers is None or caller is None:
        return None
    names, asked = frame.f_locals, caller.f_locals
    what = f"the transform from {asked.get('source_frame')} to {asked.get('target_frame')}"
    return BufferWait(names["self"], what, names["timeout"].nanoseconds / 1e9, fillers)
