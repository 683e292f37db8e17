"""Handlers that a class declares and its code registers once more, so that each is called twice."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from typing import Any

from graphflow.errors import Place
from graphflow.runtime.declarations.handlers import MARK, Handler
from graphflow.runtime.part import Part


def tell_doubled(
    log: logging.Logger, callback: Callable[..., Any] | None, place: Place, what: str, alike: Iterable[Part]
) -> None:
    """Tell of a method of a node that is registered for what its decorator has registered it for.

    Args:
        place: The line that registers it.
        what: That is, for the sentence.
        alike: The parts of the node that are for the same.
    """
    mark = getattr(callback, MARK, None)
    if not isinstance(mark, Handler) or not hasattr(callback, "__self__"):
        return
    name: str = callback.__name__  # type: ignore[union-attr]
    if any(part.handler_title == f"{mark.kind} {name}" for part in alike):
        text = "%s: %s is called twice for %s, as @%s in line %d registers it already; leave out one of the two"
        log.warning(text, place, name, what, mark.kind, mark.place.line)
