"""Nodes under a debugger: their processes wait until one has attached, and nothing hurries them.

While such a node stands at a breakpoint its process answers nobody. So in a graph with one no call has a deadline of
its own accord, and the process is neither told to be unresponsive nor given up on for taking too long to start.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import replace

from graphflow.errors import GraphFileError, GraphflowError, Place, Problem
from graphflow.graph.plan import Plan
from graphflow.names import did_you_mean


def debugged(plan: Plan, names: Sequence[str]) -> Plan:
    """The plan with nodes that are to be debugged.

    Raises:
        GraphFileError: There is no such node, or it is a foreign program.
    """
    wanted = {name if name.startswith("/") else f"/{name}" for name in names}
    known = {node.name: node for node in plan.nodes}
    problems = []
    for name in sorted(wanted):
        if name not in known:
            problems.append(f"the graph has no node {name}{did_you_mean(name, known)}")
        elif known[name].command:
            problems.append(f"{name} is a foreign program: start it under a debugger of its own")
    if problems:
        raise GraphFileError([Problem(Place("command line"), f"--debug: {text}") for text in problems])
    nodes = tuple(replace(node, is_debugged=node.name in wanted) for node in plan.nodes)
    return replace(plan, nodes=nodes, call_timeout=None)


def wait_for_debugger(tell: Callable[..., None]) -> None:
    """Open a port on loopback and wait until a debugger has attached.

    Args:
        tell: Called with the port.

    Raises:
        GraphflowError: debugpy is not installed.
    """
    os.environ.setdefault("PYDEVD_DISABLE_FILE_VALIDATION", "1")  # a warning about modules that are Python's own
    try:
        import debugpy
    except ImportError:
        raise GraphflowError("--debug needs debugpy: pip install debugpy") from None
    _, port = debugpy.listen(("127.0.0.1", 0))
    tell(port=port)
    debugpy.wait_for_client()


def invitation(process: str, port: int) -> str:
    """What to do now."""
    return (
        f"{process} waits for a debugger on 127.0.0.1:{port} (in VS Code: Run and Debug, Python Debugger, Remote "
        f"Attach); it goes on when one has attached"
    )
