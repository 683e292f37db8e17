"""A check that nodes are spun, and nothing else that a program may give in their place."""

from __future__ import annotations

from typing import Any


def check_node(node: Any, call: str) -> None:
    """Raise TypeError, with what to write, if something is no node.

    Args:
        call: The function that wants one.
    """
    if not isinstance(node, type) and hasattr(type(node), "default_callback_group"):
        return
    if isinstance(node, type):
        text = f"{call} needs a node, got the class {node.__name__}: write {call}({node.__name__}())"
    elif isinstance(node, (list, tuple)):
        text = f"{call} needs one node, got a {type(node).__name__}: add each to an executor by executor.add_node(node)"
    elif hasattr(node, "add_node"):
        text = f"{call} needs a node, got a {type(node).__name__}: write executor.add_node(node), then executor.spin()"
    else:
        name = type(node).__name__
        text = (
            f"{call} needs a node, got a {name}: write class {name}(Node), and super().__init__('name') in its __init__"
        )
        text = text if type(node).__module__ != "builtins" else f"{call} needs a node, got a {name}"
    raise TypeError(text)
