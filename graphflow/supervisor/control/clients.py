"""Clients: the consoles and commands attached to a graph, their events, and the layout kept for the next console."""

from __future__ import annotations

import itertools
import json
import logging
import time
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeAlias

from graphflow.errors import printable

if TYPE_CHECKING:
    from graphflow.supervisor.control.messages import Console, GraphEvent, Layout

logger = logging.getLogger("graphflow.supervisor")

Listener: TypeAlias = "Callable[[GraphEvent], object]"

HISTORY = 1000
"""Number of past events that a new client receives."""
LAYOUT_BOUND = 60_000
"""Largest layout, in characters of JSON."""
TEXT_BOUND = 200
"""Characters of a name or an announcement that are passed on; the rest is cut."""


class Clients:
    """The clients of one graph.

    Args:
        empty: Called when the last console has left.
    """

    def __init__(self, empty: Callable[[], None]) -> None:
        self.layout: Layout | None = None
        """The windows and panes that the last console has left, for the next one."""
        self._empty = empty
        self._history: deque[GraphEvent] = deque(maxlen=HISTORY)
        self.has_ended = False
        """Whether the `end` event has been sent."""
        self._listeners: list[Listener] = []
        self._consoles: dict[int, Console] = {}
        self._numbers = itertools.count(1)

    def broadcast(self, event: GraphEvent, *, keep: bool = True) -> None:
        """Send an event to all clients that follow the graph and, if it is kept, to those that come later."""
        if keep:
            self._history.append(event)
        self.has_ended |= event["event"] == "end"
        for listener in list(self._listeners):  # a listener may unsubscribe itself
            listener(event)
        logger.info("%s", json.dumps(event))

    def subscribe(self, listener: Listener, *, replay: bool) -> Callable[[], None]:
        """Pass events to a listener, past ones first if `replay`; returns a function that stops this."""
        if replay:
            for event in self._history:
                listener(event)
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    @property
    def consoles(self) -> list[Console]:
        """The attached consoles."""
        return list(self._consoles.values())

    def join(self, name: str) -> Callable[[], None]:
        """Add a console; returns a function that removes it."""
        number = next(self._numbers)
        self._consoles[number] = {"name": printable(name[:TEXT_BOUND]), "since": time.time()}
        self._broadcast_consoles()

        def leave() -> None:
            del self._consoles[number]
            self._broadcast_consoles()
            if not self._consoles:
                self._empty()

        return leave

    def _broadcast_consoles(self) -> None:
        self.broadcast({"event": "consoles", "consoles": self.consoles}, keep=False)

    def announce(self, text: str, by: str) -> None:
        """Send the clients what one of them has done."""
        text, by = printable(text[:TEXT_BOUND]), printable(by[:TEXT_BOUND])
        self.broadcast({"event": "announced", "text": text, "by": by}, keep=False)

    def keep_layout(self, layout: object) -> None:
        """Keep the windows and panes of a console.

        Raises:
            ValueError: It is not a JSON object, or too large.
        """
        if not isinstance(layout, dict) or len(json.dumps(layout)) > LAYOUT_BOUND:
            raise ValueError("not a layout")
        self.layout = layout
