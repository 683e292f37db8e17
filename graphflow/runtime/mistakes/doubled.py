"""Handlers that a class declares and its code registers again, so that each message is handled twice."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable

from graphflow.errors import Place
from graphflow.runtime.declarations.handlers import MARK, Handler
from graphflow.runtime.part import Part


def warn_doubled(
    log: logging.Logger, callback: Callable[..., object] | None, place: Place, what: str, alike: Iterable[Part]
) -> None:
    """Warn of a method that is registered for the same purpose as its decorator has registered it.

    Args:
        place: The line that registers it.
        what: The purpose, in words.
        alike: The node's parts with the same purpose.
    """
    mark = getattr(callback, MARK, None)
    if not isinstance(mark, Handler) or not hasattr(callback, "__self__"):
        return
    name: str = callback.__name__  # type: ignore[union-attr]
    if any(part.handler_title == f"{mark.kind} {name}" for part in alike):
        text = "%s: %s is called twice for %s, since @%s in line %d already registers it; remove one of the two"
        log.warning(text, place, name, what, mark.kind, mark.place.line)
