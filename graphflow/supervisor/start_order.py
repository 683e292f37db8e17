"""The order in which processes and steps of a plan start."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from graphflow.graph.plan import Plan, PlannedStep
from graphflow.machines.process import Need, Order, State
from graphflow.supervisor.processes.process import Process

SLOW_START = 5.0
"""Seconds after which a graph that is not up says what it waits for."""
NAMED = 3
"""The number of these that it names."""


def start_order(plan: Plan, processes: Iterable[Process]) -> Order:
    """Derive the needs of processes and steps from `after` of the plan's nodes and steps.

    A step is named `step NAME`. Nodes of one process do not wait for each other.
    """
    processes = list(processes)
    process_of = {node.name: process.name for process in processes for node in process.nodes}

    def needs(after: Mapping[str, str]) -> set[Need]:
        return {
            Need(process_of[name], what) if name in process_of else Need(f"step {name}", "done")
            for name, what in after.items()
        }

    order: dict[str, frozenset[Need]] = {}
    for process in processes:
        own = {need for node in process.nodes for need in needs(node.after)}
        order[process.name] = frozenset(need for need in own if need.name != process.name)
    for step in plan.steps:
        order[f"step {step.name}"] = frozenset(needs(step.after))
    return Order(order)


def needs_of_up(order: Order, processes: Collection[str]) -> set[Need]:
    """Return what must be met for the graph to be up.

    Processes and steps that need the end of a process are left out: it may never come.
    """
    later = order.later(processes)
    names = [name for name in order.after if name not in later]
    return {Need(name) if name in processes else Need(name, "done") for name in names}


def restarted_with(name: str, strategy: str, order: Order, processes: Iterable[str]) -> list[str]:
    """Return the other processes that are restarted when one has failed."""
    others = [other for other in processes if other != name]
    if strategy == "one_for_all":
        return others
    return [other for other in others if strategy == "rest_for_one" and name in order.all_before(other)]


def waits(steps: Iterable[PlannedStep], processes: Iterable[Process]) -> str:
    """Return what a start waits for, as in `it waits for step late, 30 s, and /camera; /arm starts after that`.

    Args:
        steps: The steps that are being carried out.
    """
    processes = list(processes)
    found = [f"step {step.name}, {step.timeout:g} s" if step.do == "delay" else f"step {step.name}" for step in steps]
    found += [name for p in processes if p.state is State.STARTING for name in sorted(p.waiting_for)]
    more = [f"{len(found) - NAMED} more"] if len(found) > NAMED else []
    later = [node.name for p in processes if p.state is State.PENDING for node in p.nodes]
    names = ", ".join([*later[:NAMED], *([f"{len(later) - NAMED} more"] if len(later) > NAMED else [])])
    after = f"; {names} start{'s' * (len(later) == 1)} after that" if later else ""
    return f"it waits for {', and '.join([*found[:NAMED], *more])}{after}"
