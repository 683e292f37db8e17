"""What all views of a console look at: the supervisor's word, the logs, the live graph."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from graphflow.graph.plan import Plan
from graphflow.tui.commands.history import History
from graphflow.tui.feeds.log_feed import Logs
from graphflow.tui.feeds.supervision import Supervision

if TYPE_CHECKING:
    from graphflow.tui.feeds.graph_feed import Live

OWN_RECORDS = 20_000
"""Records kept of one node or namespace."""
Verbs = dict[str, Any]
"""The command line as data: see `cli.tree`."""


class Hub:
    """The sources of one console.

    Args:
        supervision: None where no supervisor of ours started the nodes.
        command: The words that start `graphflow` in a process of its own.
        verbs: Reads the verbs of the command line; slow.
        history: The commands typed so far; without it they are forgotten with the console.
    """

    def __init__(
        self,
        domain: int,
        supervision: Supervision | None,
        command: tuple[str, ...],
        verbs: Callable[[], Verbs],
        history: History | None = None,
    ) -> None:
        self.domain = domain
        self.supervision = supervision
        self.command = command
        self.read_verbs = verbs
        self.history = history or History()
        self.logs = Logs()
        self.live: Live | None = None
        """None until the first screen has been drawn: importing it takes longer than that."""
        self.selected = ""
        """The node that is chosen in the list of nodes."""
        self.muted: set[str] = set()
        """Nodes that are left out of merged logs."""
        self.seen: dict[str, tuple[int, int]] = {}
        """How many errors and warnings of each node had come when its log was looked at."""

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

    def log_files(self, about: str = "") -> list[tuple[str, tuple[str, ...]]]:
        """Each log with the nodes that write it: all, or those of a node or of a namespace."""
        rows = self.supervision.nodes.values() if self.supervision is not None else ()
        below = f"{about.rstrip('/')}/"
        wanted = {row["log"] for row in rows if not about or row["node"] == about or row["node"].startswith(below)}
        found: dict[str, list[str]] = {}
        for row in rows:
            if row["log"] in wanted:
                found.setdefault(row["log"], []).append(row["node"])
        return [(log, tuple(nodes)) for log, nodes in found.items()]

    def own_logs(self, about: str) -> Logs | None:
        """The records of a node or namespace, read from its own files; None where they cannot be read here."""
        files = [file for file in self.log_files(about) if Path(file[0]).exists()]
        if not files:
            return None
        logs = Logs(OWN_RECORDS)
        logs.follow(files)
        return logs

    def unseen(self, node: str) -> tuple[int, int]:
        """Errors and warnings of a node since its log was looked at."""
        errors, warnings = self.seen.get(node, (0, 0))
        return self.logs.errors[node] - errors, self.logs.warnings[node] - warnings

    def nodes(self) -> list[str]:
        """All nodes: the supervisor's, and those that others have started."""
        mine = list(self.supervision.nodes) if self.supervision is not None else []
        seen = self.live.cache.nodes(hidden=False) if self.live is not None else []
        return [*mine, *(name for name in seen if name not in mine)]

    def announce(self, text: str) -> None:
        """Tell the other consoles what this one has done."""
        if self.supervision is not None:
            self.supervision.announce(text)
