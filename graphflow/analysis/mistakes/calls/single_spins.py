"""Programs that call `rclpy.spin_once(node)` once, and end, although their nodes have more to do."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from graphflow.analysis.syntax import LOOPS, FunctionNode, last_name, nodes_in, walk

_SPINS = ("spin", "spin_once", "spin_until_future_complete", "spin_some")
_ENDS = ("destroy_node", "shutdown", "try_shutdown")


def single_spins(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the last spin of a file if all are `spin_once` outside of loops; it comes with a sentence.

    A file without timers is left alone if anything but the end comes after it: the program may want one message. So
    are functions other than `main`.
    """
    calls = [(node, parents) for node, parents in walk(module) if isinstance(node, ast.Call)]
    names = {last_name(call.func) for call, _ in calls}
    spins = [(call, parents) for call, parents in calls if last_name(call.func) in _SPINS]
    if not spins or {last_name(spin.func) for spin, _ in spins} != {"spin_once"}:
        return
    call, parents = spins[-1]
    functions = [parent for parent in parents if isinstance(parent, FunctionNode)]
    is_helper = [function.name for function in functions] not in ([], ["main"])
    if is_helper or any(isinstance(parent, LOOPS) for _, around in spins for parent in around):
        return
    what = ""
    if "create_timer" in names:
        what = "no timer runs after it"
    elif len(call.args) + len(call.keywords) > 1:  # with a timeout, as for one message that may not come
        return
    elif not names.isdisjoint(("create_subscription", "create_service")) and _is_last(call, functions):
        what = "the program ends after it"
    if what:
        shown = ast.unparse(call.args[0]) if call.args else "node"
        text = f"{ast.unparse(call.func)} calls one callback and returns, and {what}"
        yield call.lineno, f"{text}; to run until Ctrl-C write rclpy.spin({shown})"


def _is_last(call: ast.Call, functions: Sequence[ast.AST]) -> bool:
    """Whether only the end of nodes and of rclpy follows a call in its function."""
    if not functions:
        return False
    later = [node for node in nodes_in(functions[-1]) if isinstance(node, ast.stmt) and node.lineno > call.lineno]
    return all(
        isinstance(statement, ast.Expr)
        and isinstance(statement.value, ast.Call)
        and last_name(statement.value.func) in _ENDS
        for statement in later
    )
