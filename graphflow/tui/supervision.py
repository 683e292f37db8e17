"""The console's line to the supervisor: what it says of processes, and what it is asked to do."""

from __future__ import annotations

import asyncio
import json
import os
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any

from graphflow import __version__
from graphflow.graph.plan import Plan
from graphflow.supervisor.control import open_control
from graphflow.supervisor.rundir import GraphRun

ASK_EVERY = 1.0
"""Seconds between two looks at the list of nodes."""
LINE_LIMIT = 1 << 22
"""Bytes that one line of the supervisor's may have."""
EVENTS = 500


class Supervision:
    """One run as its supervisor tells it.

    Args:
        run: The run.
        heard: Called with each event.
    """

    def __init__(self, run: GraphRun, heard: Callable[[dict[str, Any]], None]) -> None:
        self.run = run
        self.name = _own_name()
        """What other consoles call this one."""
        self.nodes: dict[str, dict[str, Any]] = {}
        """The rows of `ps` by node."""
        self.consoles: list[dict[str, Any]] = []
        self.events: deque[dict[str, Any]] = deque(maxlen=EVENTS)
        self.hello: dict[str, Any] = {}
        self.plan: Plan | None = None
        """What the graph file says, once the supervisor has told."""
        self.folder = Path()
        """What the plan's file names are relative to."""
        self.is_connected = False
        self.exit_code: int | None = None
        """The graph's exit code, once it has ended."""
        self._heard = heard
        self._writer: asyncio.StreamWriter | None = None
        self._token: dict[str, str] = {}

    async def follow(self) -> None:
        """Stay connected until the graph has ended or its supervisor has gone."""
        reader, self._writer, self._token = await open_control(self.run.socket, LINE_LIMIT)
        try:
            self.is_connected = True
            self.send(do="follow", console=self.name)
            self.send(do="ps")
            self.send(do="plan")
            asking = asyncio.create_task(self._ask())
            try:
                while line := await reader.readline():
                    self._take(json.loads(line))
            finally:
                asking.cancel()
        except (OSError, ValueError) as error:
            self._heard({"event": "lost", "message": str(error)})
        finally:
            self.is_connected = False
            self._writer.close()
            self._heard({"event": "lost", "message": "the supervisor has gone"})

    async def _ask(self) -> None:
        while True:
            await asyncio.sleep(ASK_EVERY)
            self.send(do="ps")

    def send(self, **request: Any) -> bool:
        """Send a request; returns whether there was anybody to send it to."""
        if self._writer is None or self._writer.is_closing():
            return False
        self._writer.write(json.dumps({**request, "by": self.name, **self._token}).encode() + b"\n")
        return True

    def announce(self, text: str) -> None:
        """Tell other consoles what this one has done."""
        self.send(do="announce", text=text)

    @property
    def version_note(self) -> str:
        """What to say when supervisor and console are of different versions."""
        other = self.hello.get("version", __version__)
        return "" if other == __version__ else f"the graph runs with graphflow {other}, this console is {__version__}"

    def _take(self, event: dict[str, Any]) -> None:
        what = event.get("event")
        if what == "ps":
            self.nodes = {row["node"]: row for row in event["nodes"]}
            self.consoles = event.get("consoles", [])
            self._heard(event)
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
        if what in ("ready", "exited", "starting"):
            self.send(do="ps")
        self.events.append(event)
        self._heard(event)


def _own_name() -> str:
    """The terminal's name, as `who` prints it."""
    try:
        return os.ttyname(0).removeprefix("/dev/")
    except (OSError, AttributeError):
        return f"process {os.getpid()}"
