"""Checks that nodes, executors and futures are passed to the spin functions in their places."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, Any

from graphflow.errors import Place
from rclpy.impl.callers import caller
from rclpy.task import Future

if TYPE_CHECKING:
    from rclpy.node import Node


_reported: set[Place] = set()
"""The lines whose executor has been reported."""
logger = logging.getLogger("graphflow")


def check_node(node: Any, call: str) -> None:
    """Raise a TypeError that shows the right call if something is not a node.

    Args:
        call: The function that takes a node.
    """
    if is_node(node):
        return
    if isinstance(node, type):
        text = f"{call} needs a node, got the class {node.__name__}: write {call}({node.__name__}())"
    elif isinstance(node, (list, tuple)):
        text = f"{call} needs one node, got a {type(node).__name__}: add each to an executor by executor.add_node(node)"
    elif isinstance(node, Future):
        text = f"{call} needs a node first, got a {type(node).__name__}: the future comes after the node"
    elif node is None:
        text = f"{call} needs a node, got None: the function that makes the node must return it"
    elif hasattr(node, "add_node"):
        text = f"{call} needs a node, got a {type(node).__name__}: write executor.add_node(node), then executor.spin()"
    else:
        name = type(node).__name__
        text = (
            f"{call} needs a node, got a {name}: write class {name}(Node), and super().__init__('name') in its __init__"
        )
        text = text if type(node).__module__ != "builtins" else f"{call} needs a node, got {node!r}"
    raise TypeError(text)


def check_executor(executor: object, call: str) -> None:
    """Raise a TypeError that shows the right call if the argument after the node is not an executor.

    Args:
        call: The function that takes one; None means the global executor.
    """
    if executor is None or hasattr(executor, "add_node"):
        return
    if is_node(executor):
        text = (
            f"{call} takes one node, got another node as its executor: "
            "add each node to one executor by executor.add_node(node), and then call executor.spin()"
        )
    elif isinstance(executor, (int, float)) and call != "spin":
        text = f"{call} takes an executor here, got {executor!r}: write timeout_sec={executor!r}"
    else:
        text = f"{call} takes an executor here, got {executor!r}"
    raise TypeError(text)


def check_future(future: Any, call: str) -> None:
    """Raise a TypeError that shows the right call if something is not a future.

    Args:
        call: The function that waits for it.
    """
    if hasattr(future, "add_done_callback"):
        return
    shown = repr(future)
    if callable(future):
        shown = f"{getattr(future, '__name__', shown)} without parentheses"
    raise TypeError(
        f"{call} needs a future, got {shown}: it is what call_async(request) or send_goal_async(goal) returns"
    )


def warn_no_node(call: str, thing: object) -> None:
    """Warn that a call on an executor has no effect because its argument is not a node; ROS 2 does not."""
    asked = caller(2)
    if asked is not None and thing is not None:
        text = "%s: %s does nothing, since it takes a node and got %s; write executor.%s(node)"
        logger.warning(text, asked.place, call, thing.__name__ if isinstance(thing, type) else repr(thing), call)


def warn_of_unused(node: Node, used: object) -> None:
    """Warn of an unused executor that the function which calls `rclpy.spin(node)` has created."""
    asked = caller(2)
    if asked is None:
        return
    for name, value in list(asked.frame.f_locals.items()):
        if value is used:
            continue
        spinning = None if isinstance(value, type) else getattr(value, "_graphflow", None)
        if not hasattr(type(value), "add_node") or spinning is None or spinning.turns or spinning.is_spun:
            continue
        if asked.place not in _reported and set(spinning.nodes) <= {node}:
            _reported.add(asked.place)
            text = "%s: rclpy.spin does not use the %s in %s: write rclpy.spin(node, %s)"
            logger.warning(text, asked.place, type(value).__name__, name, name)


def is_node(thing: object) -> bool:
    """Whether something is a node, and not a class of nodes."""
    return not isinstance(thing, type) and hasattr(type(thing), "default_callback_group")
