"""The nodes of the graph: how they are, how fast they publish, what they cost."""

from __future__ import annotations

import time

import psutil
from rich.text import Text

from graphflow.system import host_name
from graphflow.times import ago
from graphflow.tui.actions import Action
from graphflow.tui.bars import MARKS
from graphflow.tui.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.table import FIND, Cells, TableView

WORDS = {"foreign": "not ours", "ready": "running"}
"""States of which users know another word."""


class Costs:
    """What processes cost, between two looks."""

    def __init__(self) -> None:
        self._known: dict[int, psutil.Process] = {}

    def look(self, pid: int) -> tuple[float, int] | None:
        """Per cent of one core since the last look, and bytes of memory; None where there is no such process."""
        try:
            process = self._known.get(pid)
            if process is None:
                process = self._known[pid] = psutil.Process(pid)
            with process.oneshot():
                return process.cpu_percent(None), process.memory_info().rss
        except psutil.Error:
            self._known.pop(pid, None)
            return None


class Nodes(TableView):
    """The nodes of the graph."""

    NAME = "nodes"
    DOC = "every node: its state, rate, cost and loop lag"
    COLUMNS = ("node", "state", "rate", "cpu", "mem", "lag", "up", "↻")
    KEEPS = 2
    EMPTY = "no nodes yet"
    EVERY = 1.0
    ACTIONS = (
        Action("details", "why, or what it does", keys=("enter",), hint=True),
        Action("log", "log", keys=("l",), verb="graphflow logs {node}", hint=True),
        Action("params", "params", keys=("p",), verb="graphflow param list {node}", hint=True),
        Action("restart", "restart", keys=("r",), verb="graphflow restart {node}", hint=True),
        Action("stop", "stop", keys=("s",), verb="graphflow stop {node}", hint=True),
        FIND,
        Action("copy", "copy the name", keys=("y",)),
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._costs = Costs()

    @property
    def title(self) -> str:
        return "nodes"

    def rows(self) -> dict[str, Cells]:
        supervision, live, ink = self.hub.supervision, self.hub.live, self.ink
        if live is not None:
            live.want("numbers")
        dead = live.stuck_nodes if live is not None else set()
        known = supervision.nodes if supervision is not None else {}
        pids = self._pids_of_others()
        found: dict[str, Cells] = {}
        costs = {
            pid: self._costs.look(pid) for pid in {*pids.values(), *(r["pid"] for r in known.values() if r["pid"])}
        }
        for name in self.hub.nodes():
            row = known.get(name)
            state = row["state"] if row is not None else "foreign"
            pid = row["pid"] if row is not None else pids.get(name)
            is_up = row is None or state in ("ready", "unresponsive", "starting", "stopping", "restarting")
            cost = costs.get(pid) if pid is not None and is_up else None
            mark = MARKS["failed" if name in dead else state]
            word = "deadlock" if name in dead else WORDS.get(state, state)
            rate = live.numbers.fastest(name) if live is not None and is_up else None
            lag = live.numbers.lags.get(name) if live is not None and is_up else None
            found[name] = (
                Text(name, style=ink.node(name)),
                Text(f"{mark.glyph} {word}", style=getattr(ink, mark.ink)),
                _right("" if rate is None else f"{rate:.1f} Hz"),
                _right("" if cost is None else f"{cost[0]:.0f}%"),
                _right("" if cost is None else f"{cost[1] / 1e6:.0f}M"),
                Text("" if lag is None else _lag(lag), style=ink.bad if lag and lag > 0.1 else "", justify="right"),
                _right(ago(time.time() - row["since"]) if row is not None and is_up else ""),
                _right(str(row.get("restarts") or "") if row is not None else ""),
            )
        return found

    def _pids_of_others(self) -> dict[str, int]:
        """Process ids of nodes on this machine that somebody else has started."""
        live = self.hub.live
        if live is None:
            return {}
        here = host_name()
        by_session = {zid: token.pid for zid, token in live.processes.items() if token.host == here}
        return {e.node_name: by_session[e.zid] for e in live.cache if e.zid in by_session}

    def chosen(self) -> dict[str, str]:
        return {"node": self.key} if self.key else {}

    def on_data_table_row_selected(self) -> None:
        self.do_details()

    def do_details(self) -> None:
        row = self.hub.supervision.nodes.get(self.key) if self.hub.supervision is not None else None
        if row is not None and row["state"] in ("failed", "given_up", "ended"):
            self.open("crash", self.key)
        elif self.key:
            self.did(f"graphflow node info {self.key}")
            self.open("prompt", f"node info {self.key}", run=True)

    def do_log(self) -> None:
        if self.key:
            self.did(f"graphflow logs {self.key}")
            self.open("log", self.key)

    def do_params(self) -> None:
        if self.key:
            self.did(f"graphflow param list {self.key}")
            self.open("params", self.key)

    def do_restart(self) -> None:
        if self.key:
            self.console.deeds.restart(self.key)

    def do_stop(self) -> None:
        if self.key:
            self.console.deeds.stop_node(self.key)

    def do_copy(self) -> None:
        self.console.copy_to_clipboard(self.key)
        self.say(f"copied: {self.key}")


def _right(text: str) -> Text:
    return Text(text, justify="right")


def _lag(seconds: float) -> str:
    return f"{seconds * 1000:.0f}ms" if seconds < 1.0 else f"{seconds:.1f}s"


VIEW = Nodes
