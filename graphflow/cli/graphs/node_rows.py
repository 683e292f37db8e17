"""The states of a graph's nodes, as its supervisor reports them to `graphflow ps`."""

from __future__ import annotations

from typing import TypedDict, cast

from graphflow.supervisor.control.client import CONNECT_LIMIT, ControlClient

NodeRow = TypedDict(
    "NodeRow",
    {
        "node": str,
        "is_named": bool,
        "state": str,
        "lifecycle": str,
        "pid": int | None,
        "since": float,
        "process": str,
        "number": int,
        "class": str,
        "log": str,
        "restarts": int,
        "detail": str,
        "last_end": str,
    },
)
"""One node: see `supervisor.processes.process`."""


class Console(TypedDict):
    """A console that is attached to a graph."""

    name: str
    since: float


class GraphRows(TypedDict):
    """A supervisor's report on its graph."""

    nodes: list[NodeRow]
    consoles: list[Console]


def graph_rows(socket: str, timeout: float = CONNECT_LIMIT) -> GraphRows:
    """Query a supervisor; the lists are empty if it ends meanwhile.

    Args:
        socket: Address of its control socket.
        timeout: Seconds that it has to answer.

    Raises:
        SupervisorError: It does not answer, or is gone.
    """
    with ControlClient(socket) as client:
        client.send(do="ps")
        answer = next(client.receive(timeout), {})
    return cast("GraphRows", {"nodes": [], "consoles": [], **answer})


def node_rows(socket: str, timeout: float = CONNECT_LIMIT) -> list[NodeRow]:
    """Query a supervisor for the rows of its nodes; see `graph_rows`."""
    return graph_rows(socket, timeout)["nodes"]
