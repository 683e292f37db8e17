"""Deadlocks drawn as rings."""

from __future__ import annotations

from rich.style import Style

from graphflow.errors import Place
from graphflow.machines.waits.group_fixes import fixes
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import explained
from graphflow.machines.waits.wait_graph import ActivityView, Call, GroupView, QueueView, WaitGraph
from graphflow.tui.views.deadlock_rows import deadlock_rows
from graphflow.tui.widgets.colours import Colours

NONE = Style.null()
PLAIN = Colours(NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, (NONE,), True)
TICK = ActivityView(
    "tick",
    "timer tick",
    "/arm",
    ("g",),
    Call("c", "/add"),
    place=Place("/home/me/arm.py", 12),
    function="tick",
    age=0.25,
    process="p",
)
ADD = QueueView("q", "service add", "/arm", ("g",), ("c",), 1, process="p")
GRAPH = WaitGraph({TICK.id: TICK}, {"g": GroupView("g", "motion", "/arm")}, {ADD.id: ADD})


def test_a_ring_of_one() -> None:
    """The member holds the group that the request needs; the place is that of its wait, and f applies the best fix."""
    [deadlock] = explained(GRAPH, deadlocked(GRAPH))
    found = fixes(deadlock, GRAPH)
    rows = list(deadlock_rows(deadlock, found, GRAPH, PLAIN))
    text = [row.text.plain for row in rows]
    assert text[0].startswith(" ✖ ")
    assert {row.place for row in rows} == {"", "/home/me/arm.py:12"}
    assert any("holds group 'motion', waits for 0.2 s" in line and "arm.py:12 in tick" in line for line in text)
    assert any("service add of /arm gives: it needs group 'motion'" in line for line in text)
    assert "   └── back to the first" in text
    assert f"   f  {found[0].title}" in [line.partition("   (")[0] for line in text]
    assert f"      $ {found[0].command}" in text


def test_a_deadlock_without_a_fix() -> None:
    """The changes in the code follow the ring."""
    [deadlock] = explained(GRAPH, deadlocked(GRAPH))
    text = [row.text.plain for row in deadlock_rows(deadlock, [], GRAPH, PLAIN)]
    assert "   no key ends it at run time; the code must change:" in text
    assert not any(line.startswith("   f ") for line in text)
