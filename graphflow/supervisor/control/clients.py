"""Those who follow a graph: what they are told, who they are, and what the console keeps with the run."""

from __future__ import annotations

import itertools
import json
import logging
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from graphflow.errors import printable

logger = logging.getLogger("graphflow.supervisor")

Event = dict[str, Any]
Listener = Callable[[Event], None]

HISTORY = 1000
"""Events that those who come later are told."""
LAYOUT_BOUND = 60_000
"""Characters of JSON that a layout may have."""
WORDS_BOUND = 200
"""Characters of a name or an announcement that are passed on."""


class Clients:
    """Everybody who follows one graph.

    Args:
        empty: Called when the last console has left.
    """

    def __init__(self, empty: Callable[[], None]) -> None:
        self.layout: dict[str, Any] | None = None
        """The windows and panes that the last console has left, for the next one."""
        self._empty = empty
        self._history: deque[Event] = deque(maxlen=HISTORY)
        self.has_ended = False
        """Whether the end of the graph has been told."""
        self._listeners: list[Listener] = []
        self._consoles: dict[int, Event] = {}
        self._numbers = itertools.count(1)

    def tell(self, *, keep: bool = True, **event: Any) -> None:
        """Tell all who follow of an event, and those who come later if it is to be kept."""
        if keep:
            self._history.append(event)
        self.has_ended |= event["event"] == "end"
        for listener in list(self._listeners):
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
    def consoles(self) -> list[Event]:
        """The consoles that are attached: their names and since when, in seconds since 1970."""
        return list(self._consoles.values())

    def join(self, name: str) -> Callable[[], None]:
        """A console has come; returns a function for its leaving."""
        number = next(self._numbers)
        self._consoles[number] = {"name": printable(name[:WORDS_BOUND]), "since": time.time()}
        self._tell_consoles()

        def leave() -> None:
            del self._consoles[number]
            self._tell_consoles()
            if not self._consoles:
                self._empty()

        return leave

    def _tell_consoles(self) -> None:
        self.tell(keep=False, event="consoles", consoles=self.consoles)

    def announce(self, text: str, by: str) -> None:
        """Tell the consoles what one of them has done."""
        self.tell(keep=False, event="announced", text=printable(text[:WORDS_BOUND]), by=printable(by[:WORDS_BOUND]))

    def keep_layout(self, layout: object) -> None:
        """Keep the windows and panes of a console.

        Raises:
            ValueError: It is no layout, or too large for one.
        """
        if not isinstance(layout, dict) or len(json.dumps(layout)) > LAYOUT_BOUND:
            raise ValueError("not a layout")
        self.layout = layout
