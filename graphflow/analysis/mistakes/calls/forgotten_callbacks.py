"""Methods of rclpy nodes that nothing refers to, and that seem to be meant as callbacks: a forgotten `create_timer`."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in
from graphflow.analysis.words import methods_in, prefixes_in

_OF_NODES = re.compile(r"__\w+__|destroy_\w+|on_(configure|activate|deactivate|cleanup|shutdown|error)")
"""Methods that rclpy calls by their names."""
_LIKE_A_CALLBACK = re.compile(r"_*(on_\w+|handle_\w+|\w*(callback|_cb|_handler|listener)\w*|cb)")
"""Names of methods that take a message."""
_LIKE_A_TIMERS = re.compile(r"_*(\w*timer\w*|tick|\w+_(callback|cb))")
"""Names of methods without arguments that a timer calls."""
_MESSAGES = ("msg", "message")
"""Arguments that are messages."""


def forgotten_callbacks(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find such methods in a file with a program; each comes with the line to write.

    Other files may use the methods of a file without one.
    """
    if not any(isinstance(item, FunctionNode) and item.name == "main" for item in module.body):
        return
    mentioned, prefixes = methods_in(module), prefixes_in(module)
    for cls in nodes_in(module):
        if not isinstance(cls, ast.ClassDef) or [last_name(base) for base in cls.bases] != ["Node"]:
            continue
        for method in cls.body:
            if not isinstance(method, FunctionNode) or method.decorator_list or method.name in mentioned:
                continue
            if not _OF_NODES.fullmatch(method.name) and not method.name.startswith(prefixes) and (way := _way(method)):
                yield method.lineno, f"nothing refers to {method.name}: write {way}"


def _way(method: FunctionNode) -> str:
    """Return what would have a method called; "" if it does not seem to be meant as a callback."""
    arguments = [argument.arg for argument in (*method.args.posonlyargs, *method.args.args)][1:]
    name = f"self.{method.name}"
    match arguments:
        case [] if _LIKE_A_TIMERS.fullmatch(method.name) or _publishes(method):
            return f"self.create_timer(0.5, {name})"
        case ["request", "response"]:
            return f"self.create_service(Type, 'name', {name})"
        case ["goal_handle"]:
            return f"ActionServer(self, Type, 'name', {name})"
        case [argument] if "feedback" in argument or "feedback" in method.name:
            return f"feedback_callback={name} in send_goal_async(...)"
        case [argument] if _takes_result(method, argument):
            return f"future.add_done_callback({name})"
        case [argument] if argument in _MESSAGES or _LIKE_A_CALLBACK.fullmatch(method.name):
            return f"self.create_subscription(Type, 'topic', {name}, 10)"
    return ""


def _publishes(method: FunctionNode) -> bool:
    """Whether a method publishes, with a publisher of its node."""
    calls = [node.func for node in nodes_in(method) if isinstance(node, ast.Call)]
    return any(isinstance(call, ast.Attribute) and call.attr == "publish" and is_own(call.value) for call in calls)


def _takes_result(method: FunctionNode, argument: str) -> bool:
    """Whether a method asks its argument for a result, as that of a future."""
    calls = [ast.unparse(node.func) for node in nodes_in(method) if isinstance(node, ast.Call)]
    return f"{argument}.result" in calls
