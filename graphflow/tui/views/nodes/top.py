"""The resource use of the graph's processes, highest first."""

from __future__ import annotations

import os

from rich.text import Text

from graphflow.introspect.usage import Costs
from graphflow.names import is_hidden
from graphflow.system import host_name
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.widgets.table import FIND, ORDER, Cells, TableView


class Top(TableView):
    """The processes of the graph."""

    NAME = "top"
    DOC = "what each process costs, the dearest first"
    LEAST_WIDTH = 48
    COLUMNS = ("pid", "cpu", "mem", "threads", "time", "nodes")
    EVERY = 2.0
    ACTIONS = (
        Action("log", "log", keys=("l", "enter"), verb="graphflow logs {node}", hint=True),
        Action("by_memory", "sort by memory, or cpu", keys=("M",), hint=True),
        FIND,
        ORDER,
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._costs = Costs()
        self._by_memory = False
        self._by_pid: dict[int, list[str]] = {}

    def rows(self) -> dict[str, Cells]:
        self._by_pid = self._owners()
        return {
            str(cost.pid): (
                Text(f"{cost.pid}+{cost.children}" if cost.children else str(cost.pid), justify="right"),
                Text(f"{cost.cpu:.0f}%", style=self.colours.warn if cost.cpu > 80 else "", justify="right"),
                Text(f"{cost.memory / 1e6:.0f}M", justify="right"),
                Text(str(cost.threads), justify="right"),
                Text(f"{cost.seconds:.1f}s", justify="right"),
                Text(", ".join(cost.nodes), style=self.colours.node(cost.nodes[0])),
            )
            for cost in self._costs.look(self._by_pid, by_memory=self._by_memory)
        }

    def _owners(self) -> dict[int, list[str]]:
        found: dict[int, list[str]] = {}
        supervision, live = self.hub.supervision, self.hub.live
        if supervision is not None:
            found[supervision.run.pid] = ["the supervisor"]
            for name, row in supervision.nodes.items():
                if row["pid"] and row["state"] not in ("ended", "failed", "given_up", "waiting", "pending"):
                    found.setdefault(row["pid"], []).append(name)
        if live is not None:
            pids = {token.zid: token.pid for token in live.processes.values() if token.host == host_name()}
            for name, entity in ((e.node_name, e) for e in live.cache):
                pid = pids.get(entity.zid)
                if pid is None or (is_hidden(name) and pid in found):
                    continue
                shown = "this console" if pid == os.getpid() else "a visitor" if is_hidden(name) else name
                if shown not in found.setdefault(pid, []):
                    found[pid].append(shown)
        return found

    def chosen(self) -> dict[str, str]:
        nodes = self._by_pid.get(int(self.key), []) if self.key else []
        return {"node": nodes[0]} if nodes and nodes[0].startswith("/") else {}

    def on_data_table_row_selected(self) -> None:
        self.do_log()

    def do_log(self) -> None:
        node = self.chosen().get("node")
        if node:
            self.open("log", node)

    def do_by_memory(self) -> None:
        self._by_memory = not self._by_memory
        self.look(0.0)


VIEW = Top
