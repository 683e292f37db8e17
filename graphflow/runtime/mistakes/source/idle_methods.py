"""Methods of a node that nothing calls, and that seem to be meant as handlers, tasks or hooks."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, nodes_in
from graphflow.analysis.words import methods_in, prefixes_in
from graphflow.errors import Place
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.declare import Param
from graphflow.runtime.mistakes.hooks import hook_meant
from graphflow.runtime.mistakes.source.project_words import is_in_other_files, other_modules
from graphflow.runtime.mistakes.source.wrong_fields import message_of

_LIKE_A_HANDLER = re.compile(r"on_|handle_|.*(callback|_cb|_handler)$|(tick|timer)$")
_DECORATORS = {
    "message": '@subscription(Type, "topic")',
    "request": '@service(Type, "name")',
    "goal": '@action(Type, "name")',
}


def idle_methods(
    cls: type, definition: ast.ClassDef, file: str, module: ast.Module, space: dict[str, object]
) -> Iterator[str]:
    """Return a sentence with its place for each such method.

    Args:
        file: The file of the class.
        module: The syntax of the file.
        space: The global names of the file.
    """
    mentioned, prefixes = methods_in(module), prefixes_in(module)
    for method in definition.body:
        if not isinstance(method, FunctionNode) or method.decorator_list or method.name in mentioned:
            continue
        if method.name.startswith(("__", *prefixes)) or any(method.name in vars(parent) for parent in cls.__mro__[1:]):
            continue  # the parent calls it, or `getattr` finds it
        way = _way(cls, method, space)
        if not way or any(method.name in methods_in(other) for other in other_modules(file, method.name)):
            continue
        if not is_in_other_files(file, method.name):  # a test, or another program, may call it
            yield f"{Place(file, method.lineno)}: nothing calls {definition.name}.{method.name}{way}"


def _way(cls: type, method: FunctionNode, space: dict[str, object]) -> str:
    """Return what would have a method called, as the end of a sentence; "" if it does not seem to be meant."""
    arguments = [a for a in (*method.args.posonlyargs, *method.args.args) if a.arg != "self"]
    kind = _received(arguments[0], space) if len(arguments) == 1 else ""
    is_of_another = bool(arguments) and arguments[0].annotation is not None  # and not of a message
    if kind or (_LIKE_A_HANDLER.match(method.name) and len(arguments) <= 1 and not is_of_another):
        if not arguments and (hook := hook_meant(cls, method.name)):
            return f"; {hook}"
        decorator = _DECORATORS.get(kind) or (_DECORATORS["message"] if arguments else "@timer(1.0)")
        return f", which looks like a handler: declare it, as with {decorator} above it"
    used = "" if arguments or method.name.startswith("_") else _used_by(method, cls)
    return used and f", which uses self.{used}: write @timer(1.0) or @task above it, or call it"


def _used_by(method: FunctionNode, cls: type) -> str:
    """Return a publisher, a client or the like that a method uses; "" if it uses none."""
    ends = {name for name, declaration in declared.declarations(cls).items() if not isinstance(declaration, Param)}
    for node in nodes_in(method):
        match node:
            case ast.Call(func=ast.Attribute(value=ast.Attribute(attr=name) as end)) if name in ends and is_own(end):
                return name
    return ""


def _received(argument: ast.arg, space: dict[str, object]) -> str:
    """Return what an argument receives by its annotation: a `message`, `request` or `goal`; "" for anything else."""
    if argument.annotation is not None and ast.unparse(argument.annotation).endswith(".Handle"):
        return "goal"
    type_ = message_of(argument.annotation, space)
    if type_ is None:
        return ""
    return "request" if type_.__name__ == "Request" or type_.SCHEMA.name.endswith("_Request") else "message"
