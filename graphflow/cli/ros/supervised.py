"""Node states from this machine's supervisors, which know more than the network shows."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import NamedTuple

from graphflow.cli.graphs.node_rows import NodeRow, node_rows
from graphflow.errors import SupervisorError
from graphflow.supervisor import rundir
from graphflow.wire.process import is_stopped

LIMIT = 1.0
"""Seconds that a supervisor has to answer."""
_UNWELL = {
    "unresponsive": "is unresponsive",
    "failed": "has failed",
    "given_up": "has failed",
    "waiting": "has failed",
}
"""Descriptions of the states of `ps` that are faults."""


class Supervised(NamedTuple):
    """Faults and notes from supervisors."""

    faults: list[str]
    ended: list[str]
    """Notes on nodes of running graphs that have ended."""
    unseen: list[str]
    """Notes on running nodes that cannot be seen on the network from here."""


def supervised(seen: Collection[str]) -> Supervised:
    """Query the supervisors of this domain for faults.

    Args:
        seen: Nodes that the network shows.
    """
    found = Supervised([], [], [])
    for run in rundir.running():
        if not run.is_here:
            continue
        try:
            rows = node_rows(run.socket, LIMIT)
        except SupervisorError:
            resume = f"; it is stopped: kill -CONT {run.pid}" if is_stopped(run.pid) else ""
            found.faults.append(f"the supervisor of graph {run.graph} (process {run.pid}) does not answer{resume}")
            continue
        found.faults.extend(faults(rows))
        found.ended.extend(ended(rows))
        found.unseen.extend(unseen(rows, seen))
    return found


def faults(rows: Iterable[NodeRow]) -> list[str]:
    """Describe nodes that have failed, do not respond or are stopped (SIGSTOP)."""
    found = []
    for row in rows:
        pid = row["pid"]
        if pid and is_stopped(pid):
            found.append(f"{row['node']} (process {pid}) is stopped: kill -CONT {pid}")
        elif row["state"] in _UNWELL:
            why = row["detail"] or "its log says why"
            found.append(f"{row['node']} {_UNWELL[row['state']]}: {why}: graphflow logs {row['node']}")
    return found


def ended(rows: Iterable[NodeRow]) -> list[str]:
    """Describe nodes that have ended, normally or by `graphflow stop`."""
    names = [row["node"] for row in rows if row["state"] == "ended"]
    return [f"{name} has ended; to start it again: graphflow start {name}" for name in names]


def with_ended(error: Exception, seen: Collection[str]) -> str:
    """Return the text of an error that a node is missing for, with the nodes that have ended.

    Args:
        seen: Nodes that the network shows.
    """
    return "; ".join((str(error), *supervised(seen).ended))


def unseen(rows: Iterable[NodeRow], seen: Collection[str]) -> list[str]:
    """Describe nodes that are ready according to their supervisor but are not seen on the network."""
    lost = [r["node"] for r in rows if r["is_named"] and r["state"] == "ready" and r["node"] not in seen]
    return [f"not seen on the network, although ready for their supervisor: {', '.join(lost)}"] if lost else []
