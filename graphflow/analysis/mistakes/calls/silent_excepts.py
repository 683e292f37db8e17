"""Callbacks whose `except: pass` hides every error, such as that of a misspelt field of a message."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in

_EVERYTHING = ("Exception", "BaseException")
_TEXT = "hides every error, misspelt names included: write the exception that you expect, or log it"


def silent_excepts(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the handlers that catch everything and do nothing, around work with messages; each with a sentence.

    Only methods are searched that have a decorator, or that a call is given, as callbacks are: code that talks to a
    device, or that ends a program, may expect any error.
    """
    passed = {last_name(argument) for node in nodes_in(module) if isinstance(node, ast.Call) for argument in node.args}
    for cls in nodes_in(module):
        for method in cls.body if isinstance(cls, ast.ClassDef) else ():
            if isinstance(method, FunctionNode) and (method.decorator_list or method.name in passed):
                for tried in nodes_in(method):
                    if isinstance(tried, ast.Try) and _is_of_messages(tried.body, method):
                        yield from ((item.lineno, f"this {_TEXT}") for item in tried.handlers if _is_silent(item))


def _is_silent(handler: ast.ExceptHandler) -> bool:
    is_of_all = handler.type is None or last_name(handler.type) in _EVERYTHING
    return is_of_all and all(isinstance(statement, (ast.Pass, ast.Continue)) for statement in handler.body)


def _is_of_messages(body: list[ast.stmt], method: FunctionNode) -> bool:
    """Whether code publishes, or reads the message that a callback has been given."""
    given = [argument.arg for argument in method.args.args if argument.arg != "self"][:1]
    parts = [part for statement in body for part in nodes_in(statement) if isinstance(part, ast.Attribute)]
    return any(
        part.attr == "publish" or (isinstance(part.value, ast.Name) and part.value.id in given) for part in parts
    )
