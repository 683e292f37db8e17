"""The needs of processes and steps, as a plan gives them."""

from __future__ import annotations

from pathlib import Path

from graphflow.graph.resolve import resolve
from graphflow.machines.process import Need
from graphflow.markup import source
from graphflow.supervisor.processes.process import Process
from graphflow.supervisor.start_order import needs_of_up, start_order

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
