"""Programs that call `rclpy.spin_once(node)` once, and end, although their nodes have timers."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import LOOPS, FunctionNode, last_name, walk

_SPINS = ("spin", "spin_once", "spin_until_future_complete", "spin_some")


def single_spins(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the only spin of a file if it is a `spin_once` outside of loops; it comes with a sentence.

    Files without timers are left alone: a program may want one message and end. So are functions other than `main`.
    """
    calls = [(node, parents) for node, parents in walk(module) if isinstance(node, ast.Call)]
    names = [last_name(call.func) for call, _ in calls]
    spins = [(call, parents) for call, parents in calls if last_name(call.func) in _SPINS]
    if len(spins) != 1 or "create_timer" not in names:
        return
    [(call, parents)] = spins
    inside = [parent.name for parent in parents if isinstance(parent, FunctionNode)]
    if last_name(call.func) != "spin_once" or inside not in ([], ["main"]):
        return
    if not any(isinstance(parent, LOOPS) for parent in parents):
        shown = ast.unparse(call.args[0]) if call.args else "node"
        text = f"{ast.unparse(call.func)} calls one callback and returns, and no timer runs after it"
        yield call.lineno, f"{text}; to run until Ctrl-C write rclpy.spin({shown})"
