"""The jobs of workers: everything that a worker needs to start."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from graphflow.graph import param_places
from graphflow.graph.plan import Plan, PlannedNode
from graphflow.supervisor.rundir import log_file

if TYPE_CHECKING:
    from graphflow.supervisor.processes.messages import Job, NodeJson, WorkerJob

MESH_LIMIT = 24
"""Number of processes up to which each is a peer of every other; more are clients of the rendezvous."""


class Start(NamedTuple):
    """One process to be started, as `Starter.spawn` takes it."""

    process: str
    job: Job
    log: str
    """The file that its output is appended to."""
    env: dict[str, str]
    """Variables it gets besides the supervisor's own."""


def no_mesh(count: int) -> str:
    """Describe the way of messages in a graph with too many processes for a mesh."""
    return (
        f"{count} processes are more than a mesh carries ({MESH_LIMIT}): their messages pass through the rendezvous; "
        "nodes that share a `process:` need fewer"
    )


def worker_start(
    plan: Plan, domain: int, process: str, nodes: Sequence[PlannedNode], described: list[NodeJson], log: str
) -> Start:
    """Return the start of a worker.

    Args:
        described: Its nodes as `Plan.to_json` writes them.
        log: The file that its output goes to.
    """
    job: WorkerJob = {
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
    """Return the variables that a process gets besides the supervisor's own."""
    return {name: value for node in nodes for name, value in (param_places.variable(node) | node.env).items()}


def first_starts(plan: Plan, domain: int, logs: Path) -> Iterator[Start]:
    """Yield the starts of the workers that wait for nothing.

    Args:
        logs: The folder of the nodes' logs.
    """
    described = {node["name"]: node for node in plan.to_json()["nodes"]}
    for process, nodes in plan.processes().items():
        if not any(node.after or node.command or node.is_debugged for node in nodes):
            log = str(log_file(logs, process))
            yield worker_start(plan, domain, process, nodes, [described[node.name] for node in nodes], log)
