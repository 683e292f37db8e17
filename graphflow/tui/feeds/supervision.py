"""The connection to the supervisor: its events, and requests to it."""

from __future__ import annotations

import asyncio
import logging
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypedDict

from graphflow import __version__
from graphflow.graph.plan import Plan
from graphflow.supervisor.control.server import ControlStream
from graphflow.supervisor.rundir import GraphRun
from graphflow.system import terminal_name

POLL_INTERVAL = 1.0
"""Seconds between two requests for the list of nodes."""
LINE_LIMIT = 1 << 22
"""Maximum bytes of one line from the supervisor."""
EVENTS = 500
_OVER = ("ended", "failed", "given_up")
"""States of nodes that have ended for good."""
LEAVE_WITHIN = 1.0
"""Seconds to wait for the supervisor to read the last requests."""

logger = logging.getLogger("graphflow.console")

Event = dict[str, Any]
"""A line from the supervisor: its kind as `event`, and the fields of that kind; see `supervisor.control.server`."""

NodeRow = TypedDict(
    "NodeRow",
    {
        "node": str,
        "state": str,
        "lifecycle": str,
        "pid": int | None,
        "since": float,
        "process": str,
        "class": str,
        "log": str,
        "restarts": int,
        "detail": str,
    },
)
"""A node's row of `ps`, with the fields that the console uses."""


class ConsoleRow(TypedDict):
    """A console attached to the graph: its terminal, and the time of its arrival in seconds since 1970."""

    name: str
    since: float


class Supervision:
    """One run as reported by its supervisor.

    Args:
        run: The run.
        on_event: Called with each event.
    """

    def __init__(self, run: GraphRun, on_event: Callable[[Event], None]) -> None:
        self.run = run
        self.name = terminal_name()
        """The name of this console in other consoles."""
        self.nodes: dict[str, NodeRow] = {}
        """The rows of `ps` by node."""
        self.consoles: list[ConsoleRow] = []
        self.events: deque[Event] = deque(maxlen=EVENTS)
        self.hello: Event = {}
        self.plan: Plan | None = None
        """The resolved graph file, once the supervisor has sent it."""
        self.folder = Path()
        """The folder to which file names in the plan are relative."""
        self.is_connected = False
        self._over = asyncio.Event()
        self._is_leaving = False
        self.is_lost = False
        """Whether the connection is lost for good."""
        self.exit_code: int | None = None
        """The graph's exit code, once it has ended."""
        self._on_event = on_event
        self._stream: ControlStream | None = None

    async def follow(self) -> None:
        """Stay connected until the graph or its supervisor has ended."""
        why = "the supervisor has gone"
        polling: asyncio.Task[None] | None = None
        try:
            stream = self._stream = await ControlStream.open(self.run.socket, LINE_LIMIT)
            self.is_connected = True
            self.send(do="follow", console=self.name)
            self.send(do="ps")
            self.send(do="plan")
            polling = asyncio.create_task(self._poll())
            async for event in stream.receive():
                self._take(event)
        except (OSError, ValueError) as error:
            why = f"the connection to the supervisor is lost: {error}"
        finally:
            self.is_connected = False
            if polling is not None:
                polling.cancel()
            if self._stream is not None:
                self._stream.close()
            self._over.set()
        if self._is_leaving:
            return
        self.is_lost = True
        self.nodes = {name: self._without_supervisor(row, why) for name, row in self.nodes.items()}
        self._on_event({"event": "lost", "message": why})

    def _without_supervisor(self, row: NodeRow, why: str) -> NodeRow:
        """Return the final row of a node: ended if the graph has ended, otherwise unknown."""
        if row["state"] in _OVER:
            return row
        state = "lost" if self.exit_code is None else "ended"
        return {**row, "state": state, "pid": None, "since": time.time(), "detail": why if state == "lost" else ""}

    async def leave(self) -> None:
        """Disconnect once the supervisor has read all requests, including the last one."""
        if self._stream is None or self._over.is_set():
            return
        self._is_leaving = True
        self._stream.end_requests()
        try:
            async with asyncio.timeout(LEAVE_WITHIN):
                await self._over.wait()
        except TimeoutError:
            logger.warning("the supervisor does not read: the last requests may be lost")

    async def _poll(self) -> None:
        while True:
            await asyncio.sleep(POLL_INTERVAL)
            self.send(do="ps")

    def send(self, **request: object) -> bool:
        """Send a request; return whether there was a connection."""
        return self._stream is not None and self._stream.send(**request, by=self.name)

    def announce(self, text: str) -> None:
        """Report an action of this console to the other consoles."""
        self.send(do="announce", text=text)

    @property
    def version_note(self) -> str:
        """The warning if supervisor and console are of different versions; else empty."""
        other = self.hello.get("version", __version__)
        return "" if other == __version__ else f"the graph runs with graphflow {other}, this console is {__version__}"

    def _take(self, event: Event) -> None:
        what = event.get("event")
        if what == "ps":
            self.nodes = {row["node"]: row for row in event["nodes"]}
            self.consoles = event.get("consoles", [])
            self._on_event(event)
            return
        if what == "plan":
            self.plan, self.folder = Plan.from_json(event["plan"]), Path(event["folder"])
            return
        if what == "hello":
            self.hello = event
        elif what == "consoles":
            self.consoles = event["consoles"]
        elif what == "end":
            self.exit_code = int(event["exit_code"])
        if what in ("ready", "exited", "starting", "left"):  # rows have changed: do not wait for the next poll
            self.send(do="ps")
        self.events.append(event)
        self._on_event(event)
