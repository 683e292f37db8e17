"""Deadlocks drawn as rings, each with the changes that end it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import PurePath
from typing import NamedTuple

from rich.style import Style
from rich.text import Text

from graphflow.machines.waits.explain import group_of, headline, title, wanted
from graphflow.machines.waits.group_fixes import Fix
from graphflow.machines.waits.remedies import remedies
from graphflow.machines.waits.rings import Deadlock
from graphflow.machines.waits.wait_graph import ActivityView, WaitGraph
from graphflow.tui.feeds.log_feed import Record, plain_text
from graphflow.tui.widgets.colours import Colours
from graphflow.tui.widgets.line_view import LineView


class Row(NamedTuple):
    """A line, and the source location that it refers to."""

    text: Text
    place: str = ""
    record: Record | None = None
    """The log record of the line, if only /rosout knows its source location."""


class RowLines(LineView[Row]):
    """Lines that may refer to source locations."""

    def draw(self, row: Row) -> Iterable[tuple[str, Style]]:
        return self.draw_text(row.text)


def place_of(activity: ActivityView) -> str:
    """Return the file and line at which an activity waits; "" if unknown."""
    return f"{activity.place.file}:{activity.place.line}" if activity.place.file else ""


def short(place: str) -> str:
    """Return a place with the file's name only."""
    file, _, line = place.rpartition(":")
    return f"{PurePath(file).name}:{line}"


def deadlock_rows(deadlock: Deadlock, found: list[Fix], graph: WaitGraph, colours: Colours) -> Iterator[Row]:
    """Draw a deadlock: its headline, its ring, its victims, and what ends it.

    Args:
        found: The changes that would end it at run time, the best first.
    """
    for i, line in enumerate(headline(deadlock, graph).split("\n")):
        yield Row(Text(f" ✖ {line}" if i == 0 else f"   {line.strip()}", style=colours.bad))
    yield from _ring(deadlock, graph, colours)
    for name in deadlock.victims[:10]:
        yield Row(Text(f"     behind them: {title(graph.activities[name])}", style=colours.dim))
    yield from _fix_rows(deadlock, found, graph, colours)
    yield Row(Text(""))


def _fix_rows(deadlock: Deadlock, found: list[Fix], graph: WaitGraph, colours: Colours) -> Iterator[Row]:
    """Return the remedies of a deadlock: those that a key applies, otherwise those in the code."""
    for i, fix in enumerate(found):
        caution = f"   ({fix.caution})" if fix.caution else ""
        text = (
            (("   f  ", colours.accent), (fix.title, colours.strong))
            if i == 0
            else (("   F  ", colours.accent), fix.title)
        )
        yield Row(Text.assemble(*text, (caution, colours.dim)))
        if i == 0:
            regrouping = fix.made_in(graph.regrouping(fix.node))
            lines = regrouping.lines(fix.node, "")
            yield Row(Text(f"      $ {fix.command}", style=colours.dim))
            yield Row(Text(f"      {regrouping.where} {lines[0]}", style=colours.dim))
            yield from (Row(Text(f"        {line}", style=colours.dim)) for line in lines[1:])
    if found:
        yield Row(
            Text.assemble(
                ("   r  ", colours.accent),
                ("the whole report, with what ends it in the code", colours.dim),
            )
        )
        return
    yield Row(Text("   no key ends it at run time; the code must change:", style=colours.warn))
    for remedy in remedies(deadlock, graph) or ["see the report: r"]:
        for line in remedy.split("\n"):
            yield Row(Text(f"   {plain_text(line)}", style=colours.text))


def _ring(deadlock: Deadlock, graph: WaitGraph, colours: Colours) -> Iterator[Row]:
    """Draw the ring: each member waits for the one below, the last for the first."""
    last = len(deadlock.ring) - 1
    for i, (name, edge) in enumerate(zip(deadlock.ring, deadlock.edges, strict=True)):
        activity = graph.activities[name]
        place = place_of(activity)
        bar = ("   ┌▶ ", colours.bad) if i == 0 else ("   │  ", colours.bad)
        yield Row(Text.assemble(bar, (title(activity), colours.node(activity.node))), place)
        group_name = group_of(activity, graph)
        holds = f"holds group '{group_name}', " if group_name else ""
        where = f"   {short(place)} in {activity.function}" if place else ""
        since = f"for {activity.age:.1f} s"
        text = f"{holds}waits {since} for {wanted(edge, graph)}"
        yield Row(
            Text.assemble(("   │    ", colours.bad), (text, colours.text), (where, colours.accent)),
            place,
        )
        queue, group = graph.queues.get(edge.queue), graph.groups.get(edge.group)
        if queue is not None and group is not None and group.name:
            needs = f"which {queue.label} of {queue.node} gives: it needs group '{group.name}'"
            yield Row(Text.assemble(("   │    ", colours.bad), (needs, colours.dim)))
        yield Row(Text("   └── back to the first" if i == last else "   │  ▼", style=colours.bad))
