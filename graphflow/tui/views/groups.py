"""Who holds which group, who waits, since when and where; a deadlock as a ring, and the key that ends it."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from pathlib import PurePath
from typing import ClassVar, NamedTuple

from rich.style import Style
from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget

from graphflow.errors import CallError, RemoteError
from graphflow.introspect import concurrency
from graphflow.introspect.view import View as Graph
from graphflow.machines.explain import group_of, headline, title, wanted
from graphflow.machines.moves import Move, moves
from graphflow.machines.remedies import remedies
from graphflow.machines.rings import Deadlock
from graphflow.machines.wait_graph import FREE, ActivityView, GroupView, WaitGraph
from graphflow.tui.actions import Action
from graphflow.tui.hub import Hub
from graphflow.tui.lines import Lines
from graphflow.tui.logs import plain_text
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.wire.process import GROUPS, answer_key

MOVE_LIMIT = 2.0
"""Seconds that a node has to move a handler."""
SLOTS = 12
"""Slots of a group that are drawn one by one."""


class Row(NamedTuple):
    """A line, and where in the source it points to."""

    text: Text
    place: str = ""


class RowLines(Lines):
    """Lines that may point into the source."""

    def draw(self, row: Row) -> Iterable[tuple[str, Style]]:
        return super().draw(row.text)


class Groups(View):
    """Groups, waits and deadlocks."""

    NAME = "groups"
    DOC = "who holds and who waits; deadlocks, and the key that ends them"
    EVERY = 0.5
    ACTIONS: ClassVar[tuple[Action, ...]] = (
        Action("fix", "end the deadlock", keys=("f",), verb="graphflow groups move NODE HANDLER GROUP", hint=True),
        Action("write", "keep the fix in the graph file", keys=("w",), hint=True),
        Action("source", "go to the line of source", keys=("enter",), hint=True),
        Action("why", "the whole report", keys=("question_mark",), verb="graphflow waits"),
        Action("everything", "idle groups too", keys=("a",), hint=True),
        Action("copy", "copy the command that ends it", keys=("y",)),
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._lines = RowLines(5000, wraps=True)
        self._lines.follows = False
        self._deadlocks: list[Deadlock] = []
        self._graph = WaitGraph()
        self._moves: list[Move] = []
        self._moved: list[Move] = []
        """Moves made here, which are not in the graph file yet."""
        self._everything = False
        self._unfrozen = ""

    def compose(self) -> ComposeResult:
        yield self._lines

    @property
    def heart(self) -> Widget:
        return self._lines

    @property
    def title(self) -> str:
        return f"groups {self.about}".rstrip()

    @property
    def note(self) -> str:
        if self._deadlocks:
            return f"✖ {len(self._deadlocks)} DEADLOCK{'S' if len(self._deadlocks) > 1 else ''}" + (
                ", f ends it" if self._moves else ""
            )
        waiting = sum(a.wait is not FREE for a in self._graph.activities.values())
        return f"{waiting} waiting"

    def chosen(self) -> dict[str, str]:
        return {"node": self.about} if self.about else {}

    def look(self, now: float) -> None:
        live = self.hub.live
        if live is None:
            return
        live.want("concurrency")
        report = live.concurrency
        if report is None:
            return
        self._graph = report.graph
        before = len(self._deadlocks)
        self._deadlocks = live.deadlocks
        self._moves = [move for d in self._deadlocks for move in moves(d, report.graph)]
        if self._deadlocks:
            self._unfrozen = ""
        elif before and self._moved:
            self._unfrozen = "It moves again."
        kept = self._lines.cursor
        rows = [*self._deadlock_rows(), *self._mended_rows(), *self._group_rows(report)]
        top = self._lines.scroll_offset.y
        self._lines.replace(rows)
        self._lines.cursor = kept if kept is not None and kept < len(rows) else None
        self._lines.scroll_to(y=top, animate=False, immediate=True)

    # what is drawn

    def _deadlock_rows(self) -> Iterator[Row]:
        ink, graph = self.ink, self._graph
        for deadlock in self._deadlocks:
            yield Row(Text(f" ✖ {headline(deadlock, graph)}", style=ink.bad))
            yield from self._ring(deadlock)
            for name in deadlock.victims[:10]:
                yield Row(Text(f"     behind them: {title(graph.activities[name])}", style=ink.dim))
            found = moves(deadlock, graph)
            if found:
                move = found[0]
                who, its = " and ".join(move.handlers), "its" if len(move.handlers) == 1 else "their"
                fix = Text.assemble(
                    ("   f ", ink.accent), (f"gives {who} of {move.node} a group of {its} own", ink.strong)
                )
                yield Row(fix)
                yield Row(Text(f"     $ {move.command}", style=ink.dim))
                regrouping = graph.regrouping(move.node).moved(move.handlers, move.group)
                lines = regrouping.lines(move.node, "")
                yield Row(Text(f"     {regrouping.where} {lines[0]}", style=ink.dim))
                yield from (Row(Text(f"       {line}", style=ink.dim)) for line in lines[1:])
            else:
                yield Row(Text("   no handler that could be moved now would end it; what does:", style=ink.warn))
                for line in remedies(deadlock, graph) or ["  see the report: ?"]:
                    yield Row(Text(f"   {plain_text(line)}", style=ink.text))
            yield Row(Text(""))

    def _ring(self, deadlock: Deadlock) -> Iterator[Row]:
        """The ring, drawn: each member waits for the one below, the last for the first."""
        ink, graph, last = self.ink, self._graph, len(deadlock.ring) - 1
        for i, (name, edge) in enumerate(zip(deadlock.ring, deadlock.edges, strict=True)):
            activity = graph.activities[name]
            place = _place(activity)
            bar = ("   ┌▶ ", ink.bad) if i == 0 else ("   │  ", ink.bad)
            yield Row(Text.assemble(bar, (title(activity), ink.node(activity.node))), place)
            held = group_of(activity, graph)
            holds = f"holds group '{held}', " if held else ""
            where = f"   {_short(place)} in {activity.function}" if place else ""
            since = f"for {activity.age:.1f} s"
            text = f"{holds}waits {since} for {wanted(edge, graph)}"
            yield Row(Text.assemble(("   │    ", ink.bad), (text, ink.text), (where, ink.accent)), place)
            queue, group = graph.queues.get(edge.queue), graph.groups.get(edge.group)
            if queue is not None and group is not None and group.name:
                needs = f"which {queue.label} of {queue.node} gives: it needs group '{group.name}'"
                yield Row(Text.assemble(("   │    ", ink.bad), (needs, ink.dim)))
            yield Row(Text("   └── back to the first" if i == last else "   │  ▼", style=ink.bad))

    def _mended_rows(self) -> Iterator[Row]:
        ink = self.ink
        if not self._moved:
            return
        if self._unfrozen:
            yield Row(Text(f" ✔ {self._unfrozen}", style=ink.good))
        for move in self._moved:
            what = f"{' and '.join(move.handlers)} of {move.node} to group {move.group}"
            yield Row(Text(f"   moved {what}, until the graph stops", style=ink.text))
        yield Row(
            Text.assemble(
                ("   w ", ink.accent),
                ("writes it into the graph file", ink.strong),
                (", after showing the change", ink.dim),
            )
        )
        yield Row(Text(""))

    def _group_rows(self, report: concurrency.ConcurrencyReport) -> Iterator[Row]:
        ink, graph = self.ink, self._graph
        dead = {name for d in self._deadlocks for name in (*d.ring, *d.victims)}
        by_node: dict[str, list[GroupView]] = {}
        for group in graph.groups.values():
            if group.name and (not self.about or group.node == self.about):
                by_node.setdefault(group.node, []).append(group)
        for stall in report.stalls:
            for line in stall.split("\n"):
                yield Row(Text(f" {plain_text(line)}", style=ink.warn))
        idle = 0
        for node in sorted(by_node):
            for group in sorted(by_node[node], key=lambda g: g.name):
                holders = [a for a in graph.activities.values() if group.id in a.holds]
                queues = [q for q in graph.queues.values() if group.id in q.needs and q.waiting]
                if not holders and not queues and not self._everything:
                    idle += 1
                    continue
                limit = "no limit" if group.limit is None else f"limit {group.limit}"
                head = Text.assemble(
                    (f" {node}", ink.node(node)), (f"  {group.name} ", ink.strong), (f"{limit} ", ink.dim)
                )
                head.append(_slots(len(holders), group.limit), style=ink.bad if queues else ink.good)
                yield Row(head)
                for activity in holders:
                    yield self._activity_row(activity, "holds it", activity.id in dead)
                for queue in queues:
                    lost = f", {queue.dropped} dropped" if queue.dropped else ""
                    yield Row(Text(f"     {queue.label}: {queue.waiting} queued{lost}", style=ink.warn))
        others = [
            a
            for a in graph.activities.values()
            if a.wait is not FREE
            and not group_of(a, graph)
            and not a.is_inner
            and (not self.about or a.node == self.about)
        ]
        if others:
            yield Row(Text(" in no group", style=ink.dim))
        for activity in sorted(others, key=lambda a: -a.age):
            yield self._activity_row(activity, "", activity.id in dead)
        if not by_node and not others:
            yield Row(Text(" no groups: each handler queues behind itself only", style=ink.dim))
        elif idle:
            yield Row(
                Text(
                    f" {idle} group{'s' if idle > 1 else ''} idle; a shows {'them' if idle > 1 else 'it'}",
                    style=ink.dim,
                )
            )

    def _activity_row(self, activity: ActivityView, deed: str, is_dead: bool) -> Row:
        ink = self.ink
        place = _place(activity)
        text = Text.assemble((f"     {activity.label}", ink.bad if is_dead else ink.text))
        if deed:
            text.append(f" {deed}", style=ink.dim)
        waits = concurrency.words(activity.wait, self._graph)
        if waits:
            text.append(f", awaits {waits}, {activity.age:.1f} s", style=ink.warn if activity.age > 1.0 else ink.text)
        else:
            text.append(" running", style=ink.good)
        if place:
            text.append(f"   {_short(place)}", style=ink.accent)
        return Row(text, place)

    # actions

    def offers(self, action: Action) -> bool:
        has = {"fix": self._moves, "write": self._moved}
        return action.hint and bool(has.get(action.name, True))

    def do_fix(self) -> None:
        if not self._moves:
            self.say(
                "no handler that could be moved now would end it; what does stands below the ring"
                if self._deadlocks
                else "there is no deadlock"
            )
            return
        move = self._moves[0]
        self.work(lambda: self._move(move), group="move")

    async def _move(self, move: Move) -> None:
        live = self.hub.live
        assert live is not None
        payloads = [
            json.dumps({"node": move.node, "handler": handler, "group": move.group}).encode()
            for handler in move.handlers
        ]

        def ask(graph: Graph) -> None:
            zid = graph.cache.owners(graph.node(move.node))[0].zid
            for payload in payloads:
                try:
                    answer = graph.ask(answer_key(graph.domain, GROUPS, zid), payload, MOVE_LIMIT)
                except TimeoutError:
                    raise CallError(f"{move.node} did not answer within {MOVE_LIMIT:g} s") from None
                if answer.is_error:
                    raise RemoteError.from_payload(answer.payload, move.node)

        await live.ask(ask)
        self._moved.append(move)
        self._unfrozen = ""
        self.did(move.command)
        self.hub.announce(move.command.removeprefix("graphflow "))

    def do_write(self) -> None:
        if not self._moved:
            self.say("nothing was moved here yet; f ends a deadlock by a move")
            return
        from graphflow.graph.edit import with_group
        from graphflow.tui.writing import write_nodes

        made, graph = list(self._moved), self._graph

        def change(text: str, keys: dict[str, tuple[str, ...]]) -> str:
            for move in made:
                text = with_group(text, keys[move.node], move.group, move.handlers, graph.regrouping(move.node).groups)
            return text

        write_nodes(self.console, {m.node for m in made}, change, "the groups moved here", self._moved.clear)

    def do_source(self) -> None:
        row: Row | None = self._lines.chosen
        place = row.place if row is not None else ""
        if not place:
            place = next((r.place for r in self._lines.whole_rows if r.place), "")
        if place:
            self.open("source", place)
        else:
            self.say("nothing here waits in a line of source")

    def do_why(self) -> None:
        self.open("prompt", "waits", run=True)

    def do_everything(self) -> None:
        self._everything = not self._everything
        self.look(0.0)

    def do_copy(self) -> None:
        made = self._moves[0].command if self._moves else self.console.last_shell
        self.console.copy_to_clipboard(made)
        self.say(f"copied: {made}")


def _place(activity: ActivityView) -> str:
    return f"{activity.place.file}:{activity.place.line}" if activity.place.file else ""


def _short(place: str) -> str:
    file, _, line = place.rpartition(":")
    return f"{PurePath(file).name}:{line}"


def _slots(taken: int, limit: int | None) -> str:
    """`■□` for a limit of two, one of them taken."""
    if limit is None or limit > SLOTS:
        return f"{taken} held"
    return "■" * min(taken, limit) + "□" * max(0, limit - taken)


VIEW = Groups
