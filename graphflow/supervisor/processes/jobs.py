"""The jobs of workers: everything that one is told when it is started."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from graphflow.graph.plan import Plan, PlannedNode
from graphflow.supervisor.processes.starter import Start
from graphflow.supervisor.rundir import log_file

MESH_LIMIT = 24
"""Up to this many processes each is a peer of every other; beyond, they are clients of the rendezvous."""


def worker_start(
    plan: Plan, domain: int, process: str, nodes: Sequence[PlannedNode], described: list[dict[str, Any]], log: str
) -> Start:
    """What starts a worker.

    Args:
        described: Its nodes as of `Plan.to_json`.
        log: The file that its output goes to.
    """
    job = {
        "process": process,
        "nodes": described,
        "log": log,
        "file": plan.file,
        "root": plan.root,
        "domain": domain,
        "mode": "peer" if len(plan.processes()) <= MESH_LIMIT else "client",
        "deadlock": plan.deadlock,
        "call_timeout": plan.call_timeout,
        "allow_control": plan.allow_control,
        "debug": any(node.is_debugged for node in nodes),
    }
    return Start(process, job, log, environment_of(nodes))


def environment_of(nodes: Sequence[PlannedNode]) -> dict[str, str]:
    """Variables that a process gets besides the supervisor's own."""
    return {name: value for node in nodes for name, value in node.env.items()}


def first_starts(plan: Plan, domain: int, logs: Path) -> Iterator[Start]:
    """What starts the workers that come after nothing.

    Args:
        logs: The folder of the nodes' logs.
    """
    described = {node["name"]: node for node in plan.to_json()["nodes"]}
    for process, nodes in plan.processes().items():
        if not any(node.after or node.command or node.is_debugged for node in nodes):
            log = str(log_file(logs, process))
            yield worker_start(plan, domain, process, nodes, [described[node.name] for node in nodes], log)
