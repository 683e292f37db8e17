"""The data sources that all views of a console share: the supervisor, the logs and the running graph."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict

from graphflow.graph.plan import Plan
from graphflow.tui.commands.history import History
from graphflow.tui.feeds.log_feed import Logs
from graphflow.tui.feeds.supervision import Supervision

if TYPE_CHECKING:
    from graphflow.tui.feeds.graph_feed import Live

OWN_RECORDS = 20_000
"""Records kept of one node or namespace."""


class Verb(TypedDict, total=False):
    """A verb of the command line: see `cli.tree`."""

    help: str
    arguments: list[str]
    options: dict[str, bool]
    """Whether each option takes a value."""
    commands: dict[str, Verb]


Verbs = dict[str, Verb]


class Hub:
    """The sources of one console.

    Args:
        supervision: The connection to the supervisor; None for nodes that none of ours started.
        command: The command line that starts `graphflow` in another process.
        verbs: Reads the verbs of the command line; slow.
        history: The command history; without it, commands are forgotten with the console.
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
        """None until the first screen has been drawn, since the import takes longer than that."""
        self.selected = ""
        """The node selected in the list of nodes."""
        self.muted: set[str] = set()
        """Nodes hidden from merged logs."""
        self.seen: dict[str, tuple[int, int]] = {}
        """Number of errors and warnings by node when its log was last shown."""

    @property
    def graph(self) -> str:
        """The graph's name, or the domain if it has none."""
        return self.supervision.run.graph if self.supervision is not None else f"domain {self.domain}"

    @property
    def plan(self) -> Plan | None:
        """The resolved graph file, if there is one."""
        return self.supervision.plan if self.supervision is not None else None

    @property
    def folder(self) -> Path:
        """The folder to which file names in the plan are relative."""
        return self.supervision.folder if self.supervision is not None else Path()

    def log_files(self, about: str = "") -> list[tuple[str, tuple[str, ...]]]:
        """Return each log file with the nodes that write it: all, or those of a node or namespace."""
        rows = self.supervision.nodes.values() if self.supervision is not None else ()
        below = f"{about.rstrip('/')}/"
        wanted = {row["log"] for row in rows if not about or row["node"] == about or row["node"].startswith(below)}
        found: dict[str, list[str]] = {}
        for row in rows:
            if row["log"] in wanted:
                found.setdefault(row["log"], []).append(row["node"])
        return [(log, tuple(nodes)) for log, nodes in found.items()]

    def own_logs(self, about: str) -> Logs | None:
        """Read the records of a node or namespace from its own files; None if they are not on this machine."""
        files = [file for file in self.log_files(about) if Path(file[0]).exists()]
        if not files:
            return None
        logs = Logs(OWN_RECORDS)
        logs.follow(files)
        return logs

    def unseen(self, node: str) -> tuple[int, int]:
        """Return the numbers of errors and warnings of a node since its log was last shown."""
        errors, warnings = self.seen.get(node, (0, 0))
        return self.logs.errors[node] - errors, self.logs.warnings[node] - warnings

    def nodes(self) -> list[str]:
        """Return all nodes: the supervisor's first, then others of the domain."""
        own = list(self.supervision.nodes) if self.supervision is not None else []
        visible = self.live.cache.nodes(hidden=False) if self.live is not None else []
        return [*own, *(name for name in visible if name not in own)]

    def announce(self, text: str) -> None:
        """Report an action of this console to the other consoles."""
        if self.supervision is not None:
            self.supervision.announce(text)
