"""What the processes of the graph cost, the dearest first."""

from __future__ import annotations

import os

import psutil
from rich.text import Text

from graphflow.names import is_hidden
from graphflow.system import host_name
from graphflow.tui.actions import Action
from graphflow.tui.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.table import FIND, Cells, TableView


class Top(TableView):
    """The processes of the graph."""

    NAME = "top"
    DOC = "what each process costs, the dearest first"
    COLUMNS = ("pid", "cpu", "mem", "threads", "time", "nodes")
    EVERY = 2.0
    ACTIONS = (
        Action("log", "log", keys=("l", "enter"), verb="graphflow logs {node}", hint=True),
        Action("by_memory", "sort by memory, or cpu", keys=("M",), hint=True),
        FIND,
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._known: dict[int, psutil.Process] = {}
        self._by_memory = False
        self._by_pid: dict[int, list[str]] = {}

    def rows(self) -> dict[str, Cells]:
        self._by_pid = self._owners()
        found: list[tuple[float, int, Cells]] = []
        for pid, nodes in self._by_pid.items():
            try:
                process = self._known.setdefault(pid, psutil.Process(pid))
                with process.oneshot():
                    cpu, memory = process.cpu_percent(None), process.memory_info().rss
                    threads, times = process.num_threads(), process.cpu_times()
            except psutil.Error:
                self._known.pop(pid, None)
                continue
            used = times.user + times.system
            cells: Cells = (
                Text(str(pid), justify="right"),
                Text(f"{cpu:.0f}%", style=self.ink.warn if cpu > 80 else "", justify="right"),
                Text(f"{memory / 1e6:.0f}M", justify="right"),
                Text(str(threads), justify="right"),
                Text(f"{used:.1f}s", justify="right"),
                Text(", ".join(nodes), style=self.ink.node(nodes[0])),
            )
            found.append((memory if self._by_memory else cpu, pid, cells))
        return {str(pid): cells for _, pid, cells in sorted(found, key=lambda row: (-row[0], row[1]))}

    def _owners(self) -> dict[int, list[str]]:
        found: dict[int, list[str]] = {}
        supervision, live = self.hub.supervision, self.hub.live
        if supervision is not None:
            found[supervision.run.pid] = ["the supervisor"]
            for name, row in supervision.nodes.items():
                if row["pid"] and row["state"] not in ("ended", "failed", "given_up", "waiting", "pending"):
                    found.setdefault(row["pid"], []).append(name)
        if live is not None:
            mine = {token.zid: token.pid for token in live.processes.values() if token.host == host_name()}
            for name, entity in ((e.node_name, e) for e in live.cache):
                pid = mine.get(entity.zid)
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
