"""Handlers of services and actions that return something other than their response or result."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable

from graphflow.analysis.syntax import FunctionNode, first_line, last_name, syntax_of, walk
from graphflow.analysis.user_code import short_place
from graphflow.msgs.base import Message, name_of
from graphflow.runtime.callables import code_of


def wrong_return(
    returned: object, wanted: type[Message], callback: Callable[..., object], place: object = ""
) -> TypeError:
    """Return the error for what a handler returned.

    Args:
        wanted: The class of the response or result.
        place: The handler's place; by default that of its first line.
    """
    code = code_of(callback)
    place = place or (short_place(code.co_filename, code.co_firstlineno) if code is not None else "")
    where = f" ({place})" if place else ""
    if inspect.isawaitable(returned):
        return TypeError(_not_awaited(returned, wanted, callback, where))
    if returned is wanted:
        return TypeError(f"it returned the class {name_of(wanted)}: write {name_of(wanted)}(...){where}")
    if isinstance(returned, BaseException):
        calls = [call for call in _returned_calls(callback) if last_name(call.func) == type(returned).__name__]
        line = f" ({code.co_filename}:{calls[0].lineno})" if code is not None and len(calls) == 1 else where
        return TypeError(f"it returned an exception: write raise {returned!r}{line}")
    if returned is None:
        given = [name for name in code.co_varnames[: code.co_argcount] if name != "self"] if code is not None else []
        # A handler may be given its response to fill in, as in rclpy.
        what = given[1] if len(given) == 2 and given[1].startswith("res") else f"{name_of(wanted)}(...)"
        return TypeError(f"it returned None: end it with return {what}{where}")
    fields = wanted.SCHEMA.fields
    first = f"{fields[0].name}=..." if fields else ""
    return TypeError(f"it returned {returned!r}, not {name_of(wanted)}({first}){where}")


def _not_awaited(returned: object, wanted: type[Message], callback: Callable[..., object], where: str) -> str:
    name = getattr(returned, "__qualname__", "")
    if inspect.iscoroutine(returned):
        returned.close()  # the warning of Python, that nobody awaited it, would repeat this error
    calls = [call for call in _returned_calls(callback) if last_name(call.func) == name.rpartition(".")[2]]
    if len(calls) != 1:
        what = f"{type(returned).__name__.lower()} {name}".strip()
        return f"it returned the {what}, not {name_of(wanted)}(...): write await{where}"
    code, call = code_of(callback), ast.unparse(calls[0])
    assert code is not None
    return f"it returned {call} without await: write return await {call} ({code.co_filename}:{calls[0].lineno})"


def _returned_calls(callback: Callable[..., object]) -> list[ast.Call]:
    """Return the calls whose results a function returns."""
    function = _source(callback)
    if function is None:
        return []
    statements = (node for node, _ in walk(function, into_functions=False) if isinstance(node, ast.Return))
    return [statement.value for statement in statements if isinstance(statement.value, ast.Call)]


def _source(callback: Callable[..., object]) -> FunctionNode | None:
    code = code_of(callback)
    if code is None:
        return None
    try:
        functions = syntax_of(code.co_filename).functions
    except (OSError, SyntaxError, ValueError):  # no source to be read
        return None
    return next((f for f in functions if (f.name, first_line(f)) == (code.co_name, code.co_firstlineno)), None)
