"""`graphflow restart` and `stop`: single nodes of a running graph."""

from __future__ import annotations

from typing import Any

import click

from graphflow.cli import exits, output
from graphflow.errors import SupervisorError
from graphflow.machines.process import START_LIMIT, STOP_LIMIT
from graphflow.supervisor import rundir
from graphflow.supervisor.control import ControlClient

LIMIT = START_LIMIT + 2 * STOP_LIMIT
"""Seconds that a node may take to end and to be ready again."""

_graph = click.option("--graph", "name", metavar="NAME", help="Which running graph, if there are several.")
_nodes = click.argument("nodes", nargs=-1, required=True, metavar="NODE...")


@click.command()
@_nodes
@_graph
def restart(nodes: tuple[str, ...], name: str | None) -> int:
    """Restart nodes, whether they run or have ended. Returns when they are ready."""
    return max(_do("restart", node, name) for node in nodes)


@click.command()
@_nodes
@_graph
def stop(nodes: tuple[str, ...], name: str | None) -> int:
    """Stop nodes. The others run on; `graphflow restart` starts them again."""
    return max(_do("stop", node, name) for node in nodes)


def _do(what: str, node: str, graph: str | None) -> int:
    node = node if node.startswith("/") else f"/{node}"
    run = rundir.choose(graph)
    with ControlClient(run.socket) as client:
        client.send(do=what, node=node)
        answer = next(client.receive(), {})
    if answer.get("event") == "error":
        raise SupervisorError(answer["message"])
    row = _await(run.socket, node, "ready" if what == "restart" else "ended")
    if what == "stop":
        output.data(f"{node} has ended")
        return exits.OK
    if row["state"] != "ready":
        output.error(f"{node} did not start: {row['detail']}\n  its log: {row['log']}")
        return exits.FAILED
    output.data(f"{node} runs again, process {row['pid']}")
    return exits.OK


def _await(socket: str, node: str, wanted: str) -> dict[str, Any]:
    """The row of a node once it is as wanted, or has failed."""
    import time

    deadline = time.monotonic() + LIMIT
    while True:
        with ControlClient(socket) as client:
            client.send(do="ps")
            rows = next(client.receive(), {}).get("nodes", [])
        row: dict[str, Any] = next((r for r in rows if r["node"] == node), {})
        if row.get("state") in (wanted, "failed", "ended"):
            return row
        if time.monotonic() > deadline:
            raise SupervisorError(f"{node} is still {row.get('state')} after {LIMIT:g} s", exits.TIMEOUT)
        time.sleep(0.05)
