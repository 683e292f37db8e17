"""Whether a Python file is written for ROS 2 or for graphflow, by what it imports."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from graphflow.reading import lenient_text

_ROS = ("rclpy", "launch", "launch_ros")
"""Packages of which a program for ROS imports at least one, itself or in a module beside it."""
_KINDS = ("msg", "srv", "action")
_FOLLOWED = 20
"""Number of modules that are read for one file, at most."""


def is_graphflows(file: Path) -> bool:
    """Return whether a Python file is written for graphflow, and not for rclpy."""
    return "graphflow" in lenient_text(file) and not uses_ros(file)


def uses_ros(file: Path) -> bool:
    """Return whether a Python file imports rclpy, launch or ROS's messages, at the top or in a function.

    A file that imports none of them, nor graphflow, may start a program in a module beside it, which is read as well.
    """
    todo, seen = [file], {file}
    while todo:
        current = todo.pop()
        modules = [*_imported(current)]
        roots = {module.partition(".")[0] for module in modules}
        if not roots.isdisjoint(_ROS):
            return True
        if "graphflow" in roots:
            continue
        if any(module.split(".")[1:2] in ([kind] for kind in _KINDS) for module in modules):
            return True
        beside = {path for root in roots if (path := current.parent / f"{root}.py").is_file()}
        todo += sorted(beside - seen)[: _FOLLOWED - len(seen)]
        seen |= beside
    return False


def _imported(file: Path) -> Iterator[str]:
    """Yield the modules that a file imports, by their full names; none if it cannot be parsed."""
    try:
        tree = ast.parse(lenient_text(file))
    except (SyntaxError, ValueError):
        return
    for node in ast.walk(tree):
        match node:
            case ast.Import(names=names):
                yield from (alias.name for alias in names)
            case ast.ImportFrom(module=str(module), level=0):
                yield module
