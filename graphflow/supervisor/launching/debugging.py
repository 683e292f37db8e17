"""Nodes under a debugger: their processes wait until one has attached, and nothing hurries them.

While such a node stands at a breakpoint its process does not answer. So in a graph with one, calls have no default
timeout, and the process is neither reported as unresponsive nor given up on for a slow start.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import replace

from graphflow.errors import GraphFileError, GraphflowError, Place, Problem
from graphflow.graph.plan import Plan
from graphflow.names import did_you_mean


def debugged(plan: Plan, names: Sequence[str]) -> Plan:
    """Mark nodes of a plan as debugged.

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


def wait_for_debugger(report: Callable[[int], object]) -> None:
    """Open a port on loopback and wait until a debugger has attached.

    Args:
        report: Called with the port.

    Raises:
        GraphflowError: debugpy is not installed.
    """
    os.environ.setdefault("PYDEVD_DISABLE_FILE_VALIDATION", "1")  # silences a warning about frozen modules of Python
    try:
        import debugpy
    except ImportError:
        raise GraphflowError("--debug needs debugpy: pip install debugpy") from None
    _, port = debugpy.listen(("127.0.0.1", 0))
    report(port)
    debugpy.wait_for_client()


def invitation(process: str, port: int) -> str:
    """Describe how to attach to a process."""
    return (
        f"{process} waits for a debugger on 127.0.0.1:{port} (in VS Code: Run and Debug, Python Debugger, Remote "
        f"Attach); it goes on when one has attached"
    )
