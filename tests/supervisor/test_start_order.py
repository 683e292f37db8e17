"""The needs of processes and steps, as a plan gives them."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.graph.resolve import resolve
from graphflow.machines.process import Need, State
from graphflow.markup import source
from graphflow.supervisor.processes.process import Process
from graphflow.supervisor.start_order import needs_of_up, restarted_with, start_order, waits

TEXT = """
nodes:
  /a: {class: "n:A", process: both}
  /b: {class: "n:A", process: both, after: /a}
  /c: {class: "n:A", after: {/b: exited}}
steps:
  reset: {call: /reset, after: /a}
"""


def test_needs_are_those_of_processes(tmp_path: Path) -> None:
    """Nodes of one process do not wait for each other; what needs an end is not needed for the graph to be up."""
    plan = resolve(source.read(TEXT, "g.yaml"), tmp_path / "g.yaml")
    processes = [Process(name, nodes, "log") for name, nodes in plan.processes().items()]
    order = start_order(plan, processes)
    names = {process.name for process in processes}
    assert order.after == {
        "both": frozenset(),
        "/c": frozenset({Need("both", "exited")}),
        "step reset": frozenset({Need("both", "ready")}),
    }
    assert needs_of_up(order, names) == {Need("both"), Need("step reset", "done")}


@pytest.mark.parametrize(
    ("strategy", "others"), [("one_for_one", []), ("one_for_all", ["/b", "/c", "/d"]), ("rest_for_one", ["/b", "/c"])]
)
def test_the_strategy_chooses_what_is_restarted(tmp_path: Path, strategy: str, others: list[str]) -> None:
    """None, all others, or those that come after the failed one, directly or not."""
    nodes = [
        "/a: {class: 'n:A'}",
        "/b: {class: 'n:A', after: /a}",
        "/c: {class: 'n:A', after: /b}",
        "/d: {class: 'n:A'}",
    ]
    plan = resolve(source.read("nodes:\n  " + "\n  ".join(nodes), "g.yaml"), tmp_path / "g.yaml")
    processes = [Process(name, nodes, "log") for name, nodes in plan.processes().items()]
    names = [process.name for process in processes]
    assert restarted_with("/a", strategy, start_order(plan, processes), names) == others


def test_what_a_slow_start_waits_for(tmp_path: Path) -> None:
    """Steps, with the time of a delay, and nodes that are not ready; three of them are named."""
    text = """
nodes:
  /a: {class: "n:A"}
  /b: {class: "n:A"}
  /c: {class: "n:A"}
steps:
  late: {delay: 30.0}
  reset: {call: /reset, type: std_srvs/srv/Empty}
"""
    plan = resolve(source.read(text, "g.yaml"), tmp_path / "g.yaml")
    processes = [Process(name, nodes, "log") for name, nodes in plan.processes().items()]
    for process in processes[:2]:
        process.state = State.STARTING
    assert waits(plan.steps[:1], processes) == "it waits for step late, 30 s, and /a, and /b; /c starts after that"
    told = "it waits for step late, 30 s, and step reset, and /a, and 1 more; /c starts after that"
    assert waits(plan.steps, processes) == told
    assert waits([], processes[:2]) == "it waits for /a, and /b"
    for process in processes[1:]:
        process.state = State.PENDING
    assert waits([], [*processes, *processes[1:]]) == "it waits for /a; /b, /c, /b, 1 more start after that"
