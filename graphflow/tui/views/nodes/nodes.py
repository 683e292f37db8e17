"""The nodes of the graph: states, errors, rates and resource use."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable
from typing import TYPE_CHECKING

import psutil
from rich.text import Text

from graphflow.introspect.lifecycles import change, managed_nodes, state, transitions
from graphflow.system import host_name
from graphflow.times import ago
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.log_feed import plain_text
from graphflow.tui.feeds.supervision import NodeRow
from graphflow.tui.panes import Content
from graphflow.tui.widgets.bars import MARKS, displayed_state
from graphflow.tui.widgets.dialogs import Item, Pick
from graphflow.tui.widgets.table import FIND, ORDER, Cells, TableView

if TYPE_CHECKING:
    from graphflow.msgs.lifecycle_msgs.msg import State, Transition

STATE_NAMES = {"foreign": "not ours", "ready": "running"}
"""Names of states for display where they differ."""
GROUPINGS = ("", "namespace", "process", "host")
GROUP = "group "
"""The prefix of the keys of group rows; the names of nodes contain no space."""
REPLY_TIMEOUT, CHANGE_LIMIT = 2.0, 60.0
"""Seconds that a node has to report its state, and to change it."""
TRANSITIONS, LABEL = 32, 40
"""Maximum transitions offered, and maximum characters of their labels."""
LOG_SPAN = 2.0
"""Seconds over which log lines are counted."""
FLOOD = 100.0
"""Lines per second from which a log is marked as a flood."""


class Costs:
    """Resource use of processes, measured between updates."""

    def __init__(self) -> None:
        self._known: dict[int, psutil.Process] = {}

    def look(self, pid: int) -> tuple[float, int] | None:
        """Return per cent of one core since the last call, and bytes of memory; None if the process is gone."""
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
    DOC = "every node: its state, errors, rate, cost and loop lag"
    LEAST_WIDTH = 40
    COLUMNS = ("node", "state", "!", "rate", "cpu", "mem", "lag", "log", "up", "↻", "last trouble")
    SHED = ("node", "state", "!", "cpu", "rate", "last trouble", "lag", "log", "up", "mem", "↻")
    KEEPS = 2
    STRETCHES = True
    EMPTY = "no nodes yet"
    EVERY = 1.0
    SHOWS_STATES = True
    ACTIONS = (
        Action("details", "why, or what it does", keys=("enter",), hint=True),
        Action("log", "log", keys=("l",), verb="graphflow logs {node}", hint=True),
        Action("newest_error", "newest error", keys=("e",), hint=True),
        Action("params", "params", keys=("p",), verb="graphflow param list {node}", hint=True),
        Action("tree", "tree", keys=("x",)),
        Action("restart", "restart", keys=("r",), verb="graphflow restart {node}", hint=True),
        Action("stop", "stop", keys=("s",), verb="graphflow stop {node}", hint=True),
        Action("transition", "change its life cycle", keys=("t",), verb="graphflow lifecycle set {node} TRANSITION"),
        FIND,
        ORDER,
        Action("group", "group by namespace, process, host", keys=("b",), hint=True),
        Action("fold", "fold the group, or not", keys=("space",)),
        Action("copy", "copy the name", keys=("y",)),
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._costs = Costs()
        self._log_counts: Counter[str] = Counter()
        self._counted_at = 0.0
        self._log_rates: dict[str, float] = {}

    @property
    def title(self) -> str:
        by = self.options.get("by", "")
        return f"nodes by {by}" if by else "nodes"

    def rows(self) -> dict[str, Cells]:
        supervision, live, colours = self.hub.supervision, self.hub.live, self.colours
        if live is not None:
            live.want("numbers")
        self._count_logs()
        stuck = live.stuck_nodes if live is not None else set()
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
            word = displayed_state(row, stuck) if row is not None else "deadlock" if name in stuck else "foreign"
            mark = MARKS[word]
            rate = live.numbers.fastest(name) if live is not None and is_up else None
            lag = live.numbers.lags.get(name) if live is not None and is_up else None
            found[name] = (
                Text(name, style=colours.node(name)),
                Text(f"{mark.glyph} {STATE_NAMES.get(word, word)}", style=getattr(colours, mark.colours)),
                self._troubles(name),
                _right("" if rate is None else f"{rate:.1f} Hz"),
                _right("" if cost is None else f"{cost[0]:.0f}%"),
                _right("" if cost is None else f"{cost[1] / 1e6:.0f}M"),
                Text(
                    "" if lag is None else _lag(lag),
                    style=colours.bad if lag and lag > 0.1 else "",
                    justify="right",
                ),
                self._log_rate(name),
                _right(ago(time.time() - row["since"]) if row is not None and is_up else ""),
                _right(str(row["restarts"] or "") if row is not None else ""),
                self._last_trouble(name, row),
            )
        return found

    def _troubles(self, name: str) -> Text:
        """Return errors and warnings since the log was last shown, and topics with a mismatch."""
        colours, live = self.colours, self.hub.live
        errors, warnings = self.hub.unseen(name)
        misfits = live.misfits_of(name) if live is not None else 0
        counts = (
            (f"E{errors}", colours.bad),
            (f"W{warnings}", colours.warn),
            (f"≠{misfits}", colours.bad),
        )
        shown = [(text, style) for text, style in counts if not text.endswith("0") or len(text) > 2]
        return Text(" ").join(Text(text, style=style) for text, style in shown)

    def _last_trouble(self, name: str, row: NodeRow | None) -> Text:
        """Return why a node is not well, otherwise the last error in its log."""
        if row is not None and row["detail"]:
            return Text(plain_text(row["detail"]).replace("\n", " "), style=self.colours.bad)
        error = self.hub.logs.last_error.get(name)
        style = self.colours.bad if self.hub.unseen(name)[0] else self.colours.dim
        return Text("" if error is None else error.text, style=style)

    def _count_logs(self) -> None:
        """Update the rates of log lines per node."""
        now, counts = time.monotonic(), self.hub.logs.counts
        if now - self._counted_at >= LOG_SPAN:
            span, before = now - self._counted_at, self._log_counts
            if self._counted_at:
                self._log_rates = {name: (count - before[name]) / span for name, count in counts.items()}
            self._log_counts, self._counted_at = Counter(counts), now

    def _log_rate(self, name: str) -> Text:
        rate = self._log_rates.get(name, 0.0)
        if rate < 0.5:
            return Text("")
        is_flood = rate >= FLOOD
        return Text(
            f"{'▲' if is_flood else ''}{rate:.0f}/s", style=self.colours.warn if is_flood else "", justify="right"
        )

    # groups of nodes

    def ordered(self, rows: dict[str, Cells]) -> dict[str, Cells]:
        rows = super().ordered(rows)
        group_of = self._grouping()
        if group_of is None:
            return rows
        members: dict[str, list[str]] = {}
        for name in rows:
            members.setdefault(group_of(name), []).append(name)
        found: dict[str, Cells] = {}
        for group in sorted(members):
            is_folded = group in self._folded
            found[f"{GROUP}{group}"] = self._group_row(group, [rows[name] for name in members[group]], is_folded)
            if not is_folded:
                found |= {name: (Text("  ") + _text(rows[name][0]), *rows[name][1:]) for name in members[group]}
        return found

    def _group_row(self, group: str, rows: list[Cells], is_folded: bool) -> Cells:
        colours = self.colours
        states = Counter(str(cells[1]).partition(" ")[0] for cells in rows)
        shown = " ".join(f"{glyph}{count}" for glyph, count in states.items())
        troubles = Text(" ").join(_text(cells[2]) for cells in rows if str(cells[2])) if is_folded else Text("")
        head = Text(f"{'▸' if is_folded else '▾'} {group} ({len(rows)})", style=colours.strong)
        return (head, Text(shown, style=colours.dim), troubles, *[Text("")] * (len(self.COLUMNS) - 3))

    @property
    def _folded(self) -> list[str]:
        folded: list[str] = self.options.setdefault("folded", [])
        return folded

    def _grouping(self) -> Callable[[str], str] | None:
        supervision = self.hub.supervision
        known = supervision.nodes if supervision is not None else {}
        match self.options.get("by"):
            case "namespace":
                return lambda name: name.rpartition("/")[0] or "/"
            case "process":
                return lambda name: (known[name]["process"] or name) if name in known else "not ours"
            case "host":
                hosts = self._hosts()
                return lambda name: hosts.get(name, host_name())
        return None

    def _hosts(self) -> dict[str, str]:
        live = self.hub.live
        if live is None:
            return {}
        hosts = {zid: token.host for zid, token in live.processes.items()}
        return {e.node_name: hosts[e.zid] for e in live.cache if e.zid in hosts}

    def do_group(self) -> None:
        """Switch to the next grouping."""
        at = GROUPINGS.index(self.options.get("by", "")) + 1
        self.options["by"] = GROUPINGS[at % len(GROUPINGS)]
        self.look(0.0)

    def do_fold(self) -> None:
        """Fold or unfold the selected group, or that of the selected node."""
        group_of = self._grouping()
        if group_of is None or not (chosen := self._row_key):
            self.say("b groups the nodes first")
            return
        group = chosen.removeprefix(GROUP) if chosen.startswith(GROUP) else group_of(chosen)
        self._folded.remove(group) if group in self._folded else self._folded.append(group)
        self.look(0.0)
        self.choose(f"{GROUP}{group}")

    @property
    def key(self) -> str:
        """The selected node; empty if there is none."""
        found = self._row_key
        return "" if found.startswith(GROUP) else found

    def _pids_of_others(self) -> dict[str, int]:
        """Return the process ids of nodes on this machine that we did not start."""
        live = self.hub.live
        if live is None:
            return {}
        here = host_name()
        by_session = {zid: token.pid for zid, token in live.processes.items() if token.host == here}
        return {e.node_name: by_session[e.zid] for e in live.cache if e.zid in by_session}

    def chosen(self) -> dict[str, str]:
        return {"node": self.key} if self.key else {}

    def on_data_table_row_highlighted(self) -> None:
        if self.key:
            self.hub.selected = self.key

    def on_data_table_row_selected(self) -> None:
        self.do_details()

    def do_details(self) -> None:
        if self._row_key.startswith(GROUP):
            self.do_fold()
            return
        if self.key:
            self.hub.selected = self.key
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

    def do_newest_error(self) -> None:
        self.console.commands.show_newest_error(self.key)

    def do_params(self) -> None:
        if self.key:
            self.did(f"graphflow param list {self.key}")
            self.open("params", self.key)

    def do_tree(self) -> None:
        if self.key:
            self.open("tree", self.key)

    def do_restart(self) -> None:
        if self.key:
            self.console.commands.restart(self.key)

    def do_stop(self) -> None:
        if self.key:
            self.console.commands.stop_node(self.key)

    def do_transition(self) -> None:
        """Let the user choose one of the transitions available now, and request it."""
        node, live = self.key, self.hub.live
        if not node or live is None:
            return
        if node not in managed_nodes(live.cache):
            self.say(f"{node} is not a lifecycle node")
            return

        async def pick_transition() -> None:
            now, ways = await live.ask(lambda g: (state(g, node, REPLY_TIMEOUT), transitions(g, node, REPLY_TIMEOUT)))
            items = [Item(_label(way.transition), "", way.transition) for way in ways[:TRANSITIONS]]
            empty = "there is no transition from this state"
            self.app.push_screen(Pick(f"{node} is {_label(now)}: which transition?", items, empty), picked)

        def picked(transition: Transition | None) -> None:
            if transition is not None:
                self.work(lambda: request(transition))

        async def request(transition: Transition) -> None:
            command = f"lifecycle set {node} {_label(transition)}"
            self.did(f"graphflow {command}")
            self.hub.announce(command)
            if not await live.ask(lambda g: change(g, node, transition, CHANGE_LIMIT)):
                self.say(f"{node} did not {_label(transition)}: l shows its log", bad=True)

        self.work(pick_transition)

    def do_copy(self) -> None:
        self.console.copy(self.key)


def _label(named: State | Transition) -> str:
    """Return the printable label of a state or transition, which another process chose."""
    return plain_text(named.label[:LABEL])


def _text(cell: Text | str) -> Text:
    return cell if isinstance(cell, Text) else Text(cell)


def _right(text: str) -> Text:
    return Text(text, justify="right")


def _lag(seconds: float) -> str:
    return f"{seconds * 1000:.0f}ms" if seconds < 1.0 else f"{seconds:.1f}s"


VIEW = Nodes
