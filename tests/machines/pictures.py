"""Pictures of a graph, drawn by hand."""

from __future__ import annotations

from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    Call,
    Condition,
    GroupView,
    QueueView,
    WaitGraph,
)


def run(
    id_: str, wait: Condition = FREE, *, holds: str = "", serves: str = "", age: float = 0.0, process: str = ""
) -> ActivityView:
    return ActivityView(id_, f"timer {id_}", "/node", (holds,) if holds else (), wait, serves, age=age, process=process)


def group(id_: str, limit: int | None = 1) -> GroupView:
    return GroupView(id_, id_, "/node", limit)


def queue(id_: str, group: str, *calls: str, process: str = "") -> QueueView:
    return QueueView(id_, f"service {id_}", "/node", (group,), calls, len(calls), process=process)


def call(id_: str) -> Call:
    return Call(id_, f"/{id_}")


def picture(*things: ActivityView | GroupView | QueueView, blocked: dict[str, str] | None = None) -> WaitGraph:
    """A picture of these."""
    return WaitGraph(
        {t.id: t for t in things if isinstance(t, ActivityView)},
        {t.id: t for t in things if isinstance(t, GroupView)},
        {t.id: t for t in things if isinstance(t, QueueView)},
        blocked or {},
    )


def waits_for_itself(name: str) -> tuple[ActivityView | GroupView | QueueView, ...]:
    """A run that calls a service of its own mutex group."""
    own, asked = f"{name}_group", f"{name}_call"
    return run(name, call(asked), holds=own), group(own), queue(f"{name}_service", own, asked)


def circle(length: int) -> WaitGraph:
    """Timers of as many nodes, each of which calls a service in the group that the next one's timer holds."""
    return picture(
        *(run(f"tick{i}", call(f"call{i}"), holds=f"g{i}") for i in range(length)),
        *(group(f"g{i}") for i in range(length)),
        *(queue(f"service{i}", f"g{i}", f"call{(i - 1) % length}") for i in range(length)),
    )


DEAD, LIVE = call("stuck_call"), call("answered_soon")
"""Waits for a run that is dead, and for one that is not, in every picture with `BACKGROUND`."""
BACKGROUND = (
    *waits_for_itself("stuck"),
    run("waits_on_stuck", DEAD, serves="dead"),
    run("busy", serves="answered_soon"),
)
