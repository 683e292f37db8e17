"""Rows of `ps` for tests."""

from __future__ import annotations

from graphflow.cli.graphs.node_rows import NodeRow


def node_row(
    node: str,
    state: str = "ready",
    *,
    pid: int | None = 7,
    detail: str = "",
    log: str = "a.log",
    is_named: bool = True,
) -> NodeRow:
    """A row of class `nodes.lab:Good`; what is not given is as of a node that has just become ready."""
    return {
        "node": node,
        "is_named": is_named,
        "state": state,
        "lifecycle": "",
        "pid": pid,
        "since": 0.0,
        "process": "",
        "number": 1,
        "class": "nodes.lab:Good",
        "log": log,
        "restarts": 0,
        "detail": detail,
        "last_end": "",
    }
