"""What all views of a console look at: the supervisor's word, the logs, the live graph."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from graphflow.graph.plan import Plan
from graphflow.tui.logs import Logs
from graphflow.tui.supervision import Supervision

if TYPE_CHECKING:
    from graphflow.tui.live import Live

Verbs = dict[str, Any]
"""The command line as data: see `cli.tree`."""


class Hub:
    """The sources of one console.

    Args:
        supervision: None where no supervisor of ours started the nodes.
        command: The words that start `graphflow` in a process of its own.
        verbs: Reads the verbs of the command line; slow.
    """

    def __init__(
        self,
        domain: int,
        supervision: Supervision | None,
        command: tuple[str, ...],
        verbs: Callable[[], Verbs],
    ) -> None:
        self.domain = domain
        self.supervision = supervision
        self.command = command
        self.read_verbs = verbs
        self.logs = Logs()
        self.live: Live | None = None
        """None until the first screen has been drawn: importing it takes longer than that."""
        self.muted: set[str] = set()
        """Nodes that are left out of merged logs."""

    @property
    def graph(self) -> str:
        """The graph's name, or the domain where there is none."""
        return self.supervision.run.graph if self.supervision is not None else f"domain {self.domain}"

    @property
    def plan(self) -> Plan | None:
        """What the graph file says, where there is one."""
        return self.supervision.plan if self.supervision is not None else None

    @property
    def folder(self) -> Path:
        """What the plan's file names are relative to."""
        return self.supervision.folder if self.supervision is not None else Path()

    def nodes(self) -> list[str]:
        """All nodes: the supervisor's, and those that others have started."""
        mine = list(self.supervision.nodes) if self.supervision is not None else []
        seen = self.live.cache.nodes(hidden=False) if self.live is not None else []
        return [*mine, *(name for name in seen if name not in mine)]

    def announce(self, text: str) -> None:
        """Tell the other consoles what this one has done."""
        if self.supervision is not None:
            self.supervision.announce(text)
