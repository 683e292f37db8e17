"""Repeated endpoints and timers, such as a publisher made in each run of a timer, and duplicate subscriptions."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Hashable, Iterable

from graphflow.analysis.user_code import users_frame
from graphflow.errors import Place
from graphflow.runtime.callables import name_of
from graphflow.runtime.declarations.handlers import MARK
from graphflow.runtime.part import Host, Part

MANY = 10
"""Open parts of one kind and name, created after the start, before a warning."""


class Repeats:
    """The parts that one node has created since its start and not closed, by kind and name."""

    def __init__(self, host: Host) -> None:
        self._host = host
        self._made: dict[Part, Hashable] = {}
        self._alike: Counter[Hashable] = Counter()
        self._reported: set[Hashable] = set()

    def made(self, part: Part) -> None:
        """Count a part, and warn if there are many like it."""
        if part.is_inner:
            return
        self._made[part] = key = _key(part)
        self._alike[key] += 1
        alike = self._alike[key]
        if alike >= MANY and key not in self._reported and (place := _place()) is not None:
            self._reported.add(key)
            text = (
                "%s exists %d times, created last in %s: create it once, in __init__, or close the previous one first"
            )
            self._host.log.warning(text, _name(part), alike, place)

    def closed(self, part: Part) -> None:
        """Stop counting a part."""
        key = self._made.pop(part, None)
        if key is not None:
            self._alike[key] -= 1
            if not self._alike[key]:
                del self._alike[key]


def _name(part: Part) -> str:
    return part.title or str(getattr(part, "name", ""))


def _key(part: Part) -> Hashable:
    """Return the key of equal parts; timers include the period, since lambdas share a name."""
    return type(part), _name(part), getattr(part, "period", None)


def _place() -> Place | None:
    """Return the user's line that led here; None in another thread, such as rclpy's, which reports its own line."""
    frame = users_frame(sys._getframe(1))
    return None if frame is None else Place(frame.f_code.co_filename, frame.f_lineno)


def warn_duplicate(host: Host, parts: Iterable[Part], made: Part, callback: Callable[..., object] | None) -> None:
    """Warn of a handler that is called twice for each message, since two of the node's subscriptions call it.

    Args:
        parts: The node's existing parts.
        made: The new part: a subscription or a timer.
        callback: Its callback. `doubled` reports those that the class declares.
    """
    is_timer = not hasattr(made, "type_name")  # the other timer may be cancelled
    if callback is None or is_timer or getattr(callback, MARK, None) is not None:
        return
    same = [other for other in parts if type(other) is type(made) and other.calls == made.calls]
    if len(same) == 1:  # of more, each has been reported
        again = f", since {place} creates it again" if (place := _place()) is not None else ""
        host.log.warning("%s calls %s twice for each message%s: keep one", _name(made), name_of(callback), again)
