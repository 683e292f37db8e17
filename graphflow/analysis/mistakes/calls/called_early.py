"""Functions that are called where they should be passed, found in the source: `Thread(target=self.work())`.

Python runs them there, in the wrong thread or too early, and passes on their result. Only functions of the same file
that return nothing are reported, and `spin`, which returns at the program's end: a call may well return a function.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from graphflow.analysis.syntax import FunctionNode, last_name, walk

_GIVING = {
    "create_subscription": "message",
    "create_service": "request, response",
    "add_done_callback": "future",
    "ActionServer": "goal_handle",
}
"""The arguments of callbacks, by the function that takes them."""
_THREADS = {"Thread": 1, "Process": 1, "Timer": 1, "submit": 0, "to_thread": 0, "run_in_executor": 1}
"""Calls that run a function in a thread or process, with the position of the function among their arguments."""
TAKERS = {
    "create_timer": 1,
    "create_subscription": 2,
    "create_service": 2,
    "ActionServer": 3,
    "create_guard_condition": 0,
    "add_done_callback": 0,
    "registerCallback": 0,
    "add_on_set_parameters_callback": 0,
}
"""The same for calls that take a callback."""
_KEYWORDS = (
    *("target", "function", "callback", "execute_callback", "goal_callback", "cancel_callback"),
    *("handle_accepted_callback", "feedback_callback"),
)


class _Given(NamedTuple):
    """A call whose result is passed as a function."""

    call: ast.Call
    keyword: str
    """The argument's name, where it is passed by name."""
    taker: str
    parents: Sequence[ast.AST]


class Early(NamedTuple):
    """A function that is called early."""

    line: int
    end: int
    """The last line of its call."""
    text: str


def spins_called(code: ast.AST) -> Iterator[Early]:
    """Find the spins that are called where a thread should call them."""
    for given in _given(code, _THREADS):
        function = given.call.func
        name = ast.unparse(function)
        owner = last_name(function.value).lower() if isinstance(function, ast.Attribute) else ""
        if last_name(function) == "spin" and ("executor" in owner or owner in ("rclpy", "exec")):
            early = f"{_shown(given)} calls {name} at once, and it does not return before the program ends"
            text = f"{early}; write {_way(given, name)}"
            yield Early(given.call.lineno, given.call.end_lineno or 0, text)


def results_passed(code: ast.AST, *, is_of_threads: bool) -> Iterator[tuple[int, str]]:
    """Find the lines that pass the result of such a function; each comes with its correction.

    Args:
        is_of_threads: Whether threads should call the function, rather than a node.
    """
    silent = _returning_nothing(code)
    for given in _given(code, _THREADS if is_of_threads else TAKERS):
        called = _function(given, silent)
        if called is not None:
            shown, name = _shown(given), ast.unparse(given.call.func)
            text = f"{shown} calls {called} at once, and passes on its result, None; write {_way(given, name)}"
            yield given.call.lineno, text


def _given(code: ast.AST, takers: dict[str, int]) -> Iterator[_Given]:
    for node, parents in walk(code):
        if not isinstance(node, ast.Call) or (taker := last_name(node.func)) not in takers:
            continue
        at = takers[taker]
        name = "target" if taker in ("Thread", "Process") else ""
        passed = [(name, value) for value in node.args[at : at + 1]]
        passed += [(keyword.arg or "", keyword.value) for keyword in node.keywords if keyword.arg in _KEYWORDS]
        for keyword, value in passed:
            if isinstance(value, ast.Call):
                yield _Given(value, keyword, taker, parents)


def _shown(given: _Given) -> str:
    call = ast.unparse(given.call)
    return f"{given.keyword}={call}" if given.keyword else f"{given.taker}(..., {call})"


def _way(given: _Given, name: str) -> str:
    """Show how to pass the function, and its arguments."""
    call, named = given.call, f"{given.keyword}={name}" if given.keyword else name
    if not call.args and not call.keywords:
        return named
    if given.taker not in _THREADS:
        lambda_ = f"lambda: {ast.unparse(call)}"
        if given.taker in _GIVING:
            received = _GIVING[given.taker]
            passed = [ast.unparse(part) for part in (*call.args, *call.keywords)]
            lambda_ = f"lambda {received}: {name}({', '.join([*passed, received])})"
        return f"{given.keyword}={lambda_}" if given.keyword else lambda_
    args = [ast.unparse(value) for value in call.args]
    if given.taker in ("Thread", "Process", "Timer"):
        way = f"{named}, args=({', '.join(args)}{',' if len(args) == 1 else ''})" if args else named
        kwargs = ", ".join(f"{keyword.arg!r}: {ast.unparse(keyword.value)}" for keyword in call.keywords)
        return f"{way}, kwargs={{{kwargs}}}" if kwargs else way
    return ", ".join([named, *args, *(f"{keyword.arg}={ast.unparse(keyword.value)}" for keyword in call.keywords)])


def _function(given: _Given, silent: set[str]) -> str | None:
    """Return the name of a called function that returns nothing; None for any other."""
    match given.call.func:
        case ast.Name(id=name) if name in silent:
            return name
        case ast.Attribute(value=ast.Name("self"), attr=name) if f"self.{name}" in silent:
            own = next((node for node in reversed(given.parents) if isinstance(node, ast.ClassDef)), None)
            methods = [item.name for item in own.body if isinstance(item, FunctionNode)] if own is not None else []
            return name if name in methods else None
    return None


def _returning_nothing(code: ast.AST) -> set[str]:
    """Return the functions, and the methods with their `self.`, whose only meaning is a function without a result."""
    found: list[str] = []
    others: set[str] = set()
    for node, parents in walk(code):
        match node:
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                name = f"self.{node.name}" if parents and isinstance(parents[-1], ast.ClassDef) else node.name
                (found.append if _returns_nothing(node) else others.add)(name)
            case ast.Attribute(attr=name, ctx=ast.Store()):
                others.add(f"self.{name}")
            case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name) | ast.ClassDef(name=name):
                others.add(name)
                if any(isinstance(parent, ast.ClassDef) for parent in parents[-2:]):
                    others.add(f"self.{name}")
            case ast.alias():
                others.add(node.asname or node.name)
    return {name for name in found if found.count(name) == 1} - others


def _returns_nothing(function: FunctionNode) -> bool:
    if isinstance(function, ast.AsyncFunctionDef) or function.decorator_list:
        return False
    for node, _ in walk(function, into_functions=False):
        if isinstance(node, (ast.Yield, ast.YieldFrom)) or (isinstance(node, ast.Return) and node.value is not None):
            return False
    return not all(isinstance(item, (ast.Pass, ast.Raise, ast.Expr)) and not _is_call(item) for item in function.body)


def _is_call(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.Expr) and not isinstance(statement.value, ast.Constant)
