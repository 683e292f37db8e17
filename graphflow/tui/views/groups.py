"""Groups, their holders and the waits between them; deadlocks as rings, with the key that ends each."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import ClassVar, NamedTuple

from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget

from graphflow.introspect import concurrency
from graphflow.introspect.graph_view import View as Graph
from graphflow.machines.waits.explain import group_of, headline
from graphflow.machines.waits.group_fixes import Fix, Thread, fixes
from graphflow.machines.waits.rings import Deadlock
from graphflow.machines.waits.wait_graph import FREE, ActivityView, GroupView, WaitGraph
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.log_feed import Record, plain_text
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.views.deadlock_rows import Row, RowLines, deadlock_rows, place_of, short
from graphflow.tui.widgets.dialogs import Item, Pick

REPLY_TIMEOUT = 2.0
"""Seconds that a node has to change its groups."""
INEFFECTIVE_AFTER, RESTARTED_WITHIN = 2.5, 12.0
"""Seconds after which a change counts as ineffective; longer if it restarts the node."""
SLOTS = 12
"""Maximum slots of a group drawn individually."""


Ring = frozenset[tuple[str, str]]
"""The members of a deadlock, each with the queue that it waits for."""


class Applied(NamedTuple):
    """A change made here, and the deadlocks before it."""

    fix: Fix
    rings: dict[Ring, str]
    at: float
    """The time by the monotonic clock."""


class Groups(View):
    """Groups, waits and deadlocks."""

    NAME = "groups"
    DOC = "who holds and who waits; deadlocks, and the key that ends them"
    LEAST_WIDTH = 60
    EVERY = 0.5
    ACTIONS: ClassVar[tuple[Action, ...]] = (
        Action("fix", "end the deadlock", keys=("f",), verb="graphflow groups move NODE HANDLER GROUP", hint=True),
        Action(
            "choose_fix", "other ways to end it", keys=("F",), verb="graphflow groups limit NODE GROUP N", hint=True
        ),
        Action("write", "keep it in the graph file", keys=("w",), hint=True),
        Action("source", "go to the line of source", keys=("enter",), hint=True),
        Action("why", "the whole report", keys=("r",), verb="graphflow waits", hint=True),
        Action("everything", "idle groups too", keys=("a",), hint=True),
        Action("copy", "copy the command that ends it", keys=("y",)),
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._lines = RowLines(5000, wraps=True)
        self._lines.follows = False
        self._deadlocks: list[Deadlock] = []
        self._graph = WaitGraph()
        self._fixes: list[list[Fix]] = []
        """The changes that would end each deadlock."""
        self._changes: list[Fix] = []
        """Changes made here that are not in the graph file yet."""
        self._applied: Applied | None = None
        """The last change, until its effect is known."""
        self._outcome = ""
        """A description of the last change's effect."""
        self._is_freed = False
        """Whether changes, made here or in the graph file, have ended all deadlocks."""
        self._everything = False

    def compose(self) -> ComposeResult:
        yield self._lines

    @property
    def focus_target(self) -> Widget:
        return self._lines

    @property
    def title(self) -> str:
        return f"groups {self.about}".rstrip()

    @property
    def note(self) -> str:
        if self._deadlocks:
            return f"✖ {len(self._deadlocks)} DEADLOCK{'S' if len(self._deadlocks) > 1 else ''}" + (
                ", f ends it" if any(self._fixes) else ""
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
        self._deadlocks = live.deadlocks
        self._fixes = [fixes(deadlock, report.graph) for deadlock in self._deadlocks]
        self._is_freed &= not self._deadlocks
        if self._applied is not None:
            self._evaluate(self._applied, live.requested_at, now)
        kept = self._lines.cursor
        rows = [*self._outcome_rows(), *self._deadlock_rows(), *self._race_rows(), *self._change_rows()]
        rows += self._group_rows(report)
        top = self._lines.scroll_offset.y
        self._lines.replace(rows)
        self._lines.cursor = kept if kept is not None and kept < len(rows) else None
        self._lines.scroll_to(y=top, animate=False, immediate=True)

    def _rings(self) -> dict[Ring, str]:
        """The headlines of the deadlocks, by their members and the queues that those wait for."""
        return {_key(deadlock): headline(deadlock, self._graph) for deadlock in self._deadlocks}

    def _evaluate(self, applied: Applied, requested_at: float, now: float) -> None:
        """Determine the effect of a change, once there is a report newer than it."""
        if requested_at <= applied.at:
            return
        rings = self._rings()
        ended = [text for ring, text in applied.rings.items() if ring not in rings]
        limit = RESTARTED_WITHIN if isinstance(applied.fix, Thread) else INEFFECTIVE_AFTER
        if not ended and now - applied.at < limit:
            return
        self._applied = None
        fresh = sum(ring not in applied.rings for ring in rings)
        left = f"{len(rings)} deadlock{'s' if len(rings) > 1 else ''}"
        if not ended:
            self._outcome = f"Still stuck {now - applied.at:.0f} s after it; F has other ways."
            self.say(self._outcome, bad=True)
        elif not rings:
            self._outcome, self._is_freed = "It moves again.", True
            self.say(f"ended: {_first_line(ended[0])}; nothing is stuck any more")
        else:
            which = f"a new one, {left} now" if fresh else f"{left} left"
            self._outcome = f"One ended; {which}: f again."
            self.say(f"ended: {_first_line(ended[0])}; {which}: f again")

    # rows

    def _deadlock_rows(self) -> Iterator[Row]:
        for deadlock, found in zip(self._deadlocks, self._fixes, strict=True):
            yield from deadlock_rows(deadlock, found, self._graph, self.colours)

    def _outcome_rows(self) -> Iterator[Row]:
        """Return the effect of the last change, above the remaining deadlocks, which look like those before it."""
        colours, is_over = self.colours, not self._deadlocks
        if self._changes and self._outcome:
            yield Row(
                Text(
                    f" {'✔' if is_over else '●'} {self._outcome}",
                    style=colours.good if is_over else colours.warn,
                )
            )

    def _race_rows(self) -> Iterator[Row]:
        """Return the lost updates. Only a change of the source prevents them, so each line refers to it."""
        colours = self.colours
        for report in self.hub.logs.races:
            for i, line in enumerate(report):
                text = f" ⇄ {line.text}" if i == 0 else f"   {line.text.strip()}"
                yield Row(Text(text, style=colours.warn if i == 0 else colours.text), record=report[0])
            yield Row(Text(""))

    def _change_rows(self) -> Iterator[Row]:
        colours = self.colours
        if not self._changes:
            return
        for fix in self._changes:
            yield Row(Text(f"   done here: {fix.title}; until the graph stops", style=colours.text))
        keep = (
            ("   w  ", colours.accent),
            ("keep it in the graph file", colours.strong),
            (", after showing the change", colours.dim),
        )
        yield Row(Text.assemble(*keep))
        yield Row(Text(""))

    def _group_rows(self, report: concurrency.ConcurrencyReport) -> Iterator[Row]:
        colours, graph = self.colours, self._graph
        for stall in report.stalls:
            yield from (Row(Text(f" {plain_text(line)}", style=colours.warn)) for line in stall.split("\n"))
        groups = [g for g in graph.groups.values() if g.name and self._is_about(g.node)]
        drawn = [list(self._rows_of(group)) for group in sorted(groups, key=lambda g: (g.node, g.name))]
        for rows in drawn:
            yield from rows
        ungrouped = [
            a
            for a in graph.activities.values()
            if a.wait is not FREE and not group_of(a, graph) and not a.is_inner and self._is_about(a.node)
        ]
        if ungrouped:
            yield Row(Text(" in no group", style=colours.dim))
        yield from (self._activity_row(activity) for activity in sorted(ungrouped, key=lambda a: -a.age))
        yield from (Row(Text(f" {text}", style=colours.dim)) for text in self._summary(drawn, bool(ungrouped)))

    def _is_about(self, node: str) -> bool:
        return not self.about or node == self.about

    def _rows_of(self, group: GroupView) -> Iterator[Row]:
        """Draw a group with its holders and queues; nothing if it is idle and idle groups are hidden."""
        colours, graph = self.colours, self._graph
        holders = [a for a in graph.activities.values() if group.id in a.holds]
        queues = [q for q in graph.queues.values() if group.id in q.needs and q.waiting]
        if not (holders or queues or self._everything):
            return
        head = Text.assemble(
            (f" {group.node}", colours.node(group.node)),
            (f"  {group.name} ", colours.strong),
            ("no limit " if group.limit is None else f"limit {group.limit} ", colours.dim),
        )
        head.append(_slots(len(holders), group.limit), style=colours.bad if queues else colours.good)
        yield Row(head)
        yield from (self._activity_row(activity, " holds it") for activity in holders)
        for queue in queues:
            lost = f", {queue.dropped} dropped" if queue.dropped else ""
            yield Row(Text(f"     {queue.label}: {queue.waiting} queued{lost}", style=colours.warn))

    def _summary(self, groups: list[list[Row]], has_ungrouped: bool) -> Iterator[str]:
        if not (self._deadlocks or self.hub.logs.races or self._changes):
            yield "no deadlock; for lost updates: graphflow up --races"
        idle = sum(not rows for rows in groups)
        if not groups and not has_ungrouped:
            yield "no groups: each handler queues behind itself only"
        elif idle:
            yield f"{idle} group{'s' if idle > 1 else ''} idle; a shows {'them' if idle > 1 else 'it'}"

    def _activity_row(self, activity: ActivityView, note: str = "") -> Row:
        colours = self.colours
        is_dead = any(activity.id in (*d.ring, *d.victims) for d in self._deadlocks)
        place = place_of(activity)
        text = Text.assemble((f"     {activity.label}", colours.bad if is_dead else colours.text))
        text.append(note, style=colours.dim)
        waits = concurrency.describe(activity.wait, self._graph)
        if waits:
            text.append(
                f", awaits {waits}, {activity.age:.1f} s",
                style=colours.warn if activity.age > 1.0 else colours.text,
            )
        else:
            text.append(" running", style=colours.good)
        if place:
            text.append(f"   {short(place)}", style=colours.accent)
        return Row(text, place)

    # actions

    def offers(self, action: Action) -> bool:
        has = {"fix": any(self._fixes), "choose_fix": sum(map(len, self._fixes)) > 1, "write": bool(self._changes)}
        return action.hint and has.get(action.name, True)

    def _refusal(self) -> str:
        """Return the reason why nothing can be applied; empty if something can."""
        if not self._deadlocks:
            return "a race is ended in the code: enter opens it" if self.hub.logs.races else "there is no deadlock"
        return "" if any(self._fixes) else "no key ends it; what does stands below the ring"

    def do_fix(self) -> None:
        if refusal := self._refusal():
            self.say(refusal)
            return
        fix = next(found[0] for found in self._fixes if found)
        self.work(lambda: self._apply(fix), group="fix")

    def do_choose_fix(self) -> None:
        if refusal := self._refusal():
            self.say(refusal)
            return

        def picked(fix: Fix | None) -> None:
            if fix is not None:
                self.work(lambda: self._apply(fix), group="fix")

        items = [Item(fix.title, fix.caution, fix) for found in self._fixes for fix in found]
        self.app.push_screen(Pick("End the deadlock: one of these", items), picked)

    async def _apply(self, fix: Fix) -> None:
        live, supervision = self.hub.live, self.hub.supervision
        assert live is not None
        rings = self._rings()
        if isinstance(fix, Thread):
            if supervision is None or fix.node not in supervision.nodes:
                self.say(f"{fix.node} was not started by this graph's supervisor; in the code: thread=True", bad=True)
                return
            supervision.send(do="restart", node=fix.node, threads=list(fix.handlers))
        else:
            wanted = fix.requests

            def ask(graph: Graph) -> None:
                concurrency.change_groups(graph, graph.node(fix.node), wanted, REPLY_TIMEOUT)

            await live.ask(ask)
        self._changes.append(fix)
        self._outcome = "The node is being started again ..." if isinstance(fix, Thread) else ""
        self._applied = Applied(fix, rings, time.monotonic())
        self.did(fix.command)
        if not isinstance(fix, Thread):  # the supervisor announces restarts itself
            self.hub.announce(fix.command.removeprefix("graphflow "))

    def do_write(self) -> None:
        if not self._changes:
            self.say(
                "nothing was changed here yet: f or F first" if any(self._fixes) else "nothing was changed here yet"
            )
            return
        from graphflow.graph.edit import with_group
        from graphflow.tui.widgets.file_changes import write_nodes

        changes, graph = list(self._changes), self._graph

        def change(text: str, keys: dict[str, tuple[str, ...]]) -> str:
            for fix in changes:
                groups = graph.regrouping(fix.node).groups
                text = with_group(text, keys[fix.node], fix.group, fix.handlers, groups, fix.settings)
            return text

        write_nodes(self.console, {fix.node for fix in changes}, change, "the groups changed here", self._changes.clear)

    def do_source(self) -> None:
        rows = [*self._lines.whole_rows]
        row: Row | None = self._lines.chosen
        if row is None or not (row.place or row.record):
            row = next((r for r in rows if r.place or r.record), None)
        if row is None:
            self.say("nothing here waits in a line of source")
        elif row.record is None:
            self.open("source", row.place)
        else:
            report = row.record
            self.work(lambda: self._open_report(report), group="source")

    async def _open_report(self, report: Record) -> None:
        live = self.hub.live
        place = None if live is None else await live.source_of(report.stamp, report.text)
        if place is None:
            self.say("this report is older than the console: its line of source is not known here")
        else:
            self.open("source", place)

    def do_why(self) -> None:
        self.open("prompt", "waits", run=True)

    def do_everything(self) -> None:
        self._everything = not self._everything
        self.look(0.0)

    def do_copy(self) -> None:
        best = next((found[0].command for found in self._fixes if found), "")
        self.console.copy(best or self.console.last_shell)


def _key(deadlock: Deadlock) -> Ring:
    """Return the identity of a deadlock across reports: the waiting nodes and handlers."""
    return frozenset((name, edge.queue) for name, edge in zip(deadlock.ring, deadlock.edges, strict=True))


def _first_line(text: str) -> str:
    return text.partition("\n")[0]


def _slots(taken: int, limit: int | None) -> str:
    """Return `■□` for two slots, one of them taken."""
    if limit is None or limit > SLOTS:
        return f"{taken} held"
    return "■" * min(taken, limit) + "□" * max(0, limit - taken)


VIEW = Groups
