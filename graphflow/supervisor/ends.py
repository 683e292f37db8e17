"""Decisions on the end of a process that is not restarted: whether it failed, and whether the graph goes on."""

from __future__ import annotations

from typing import NamedTuple

from graphflow.machines.process import Need, Order, State
from graphflow.supervisor.processes.process import Process


class GraphEnd(NamedTuple):
    """The end of a graph because of one of its processes."""

    reason: str
    failed: bool
    """Whether the graph ends with exit code 1."""


def was_stopped(process: Process, was: State) -> bool:
    """Return whether a process ended by request: it was asked to stop, or had not been started.

    Args:
        was: Its state before the end.
    """
    return process.stop_requested or was in (State.STOPPING, State.PENDING, State.WAITING)


def has_failed(process: Process, was: State) -> bool:
    """Return whether the end of a process is a failure; before it was ready, even exit code 0 is one.

    Args:
        was: Its state before the end.
    """
    if was_stopped(process, was):
        return False
    return was is State.STARTING or (process.exit is not None and process.exit.failed)


def end_of_graph(process: Process, was: State, order: Order, *, is_up: bool) -> GraphEnd | None:
    """Return the end of the graph that follows from that of a process; None if the graph goes on.

    Args:
        was: The state of the process before its end.
        is_up: Whether the graph has been up.
    """
    if was is State.STARTING and not is_up:
        return GraphEnd(f"{process.name} did not start", failed=True)
    if process.failed and process.is_critical:
        how = "been given up" if process.given_up else "failed"
        return GraphEnd(f"{process.name} is critical, and has {how}", failed=True)
    if process.ends_graph:
        return GraphEnd(f"{process.name} has ended", failed=False)
    waiting = [name for name, needs in order.after.items() if Need(process.name, "done") in needs]
    if process.failed and waiting:
        return GraphEnd(f"{waiting[0]} waits until {process.name} is done, and that has failed", failed=True)
    return None
