"""Lifecycle hooks that nothing calls, in programs for rclpy: `on_activated`, or a class that derives from Node."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in
from graphflow.names import nearest

_HOOKS = ("on_configure", "on_activate", "on_deactivate", "on_cleanup", "on_shutdown", "on_error")
_OWN = {"on_configure", "on_activate", "on_deactivate"}
"""Hooks that only lifecycle nodes have; other classes may use the other names in another way."""


def lifecycle_hooks(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find such hooks in a file; each comes with the name, or the base class, that makes it one."""
    used = {n.attr for n in nodes_in(module) if isinstance(n, ast.Attribute) and not isinstance(n.value, ast.Call)}
    for cls in nodes_in(module):
        if not isinstance(cls, ast.ClassDef):
            continue
        bases = [last_name(base) for base in cls.bases]
        hooks = [m for m in cls.body if isinstance(m, FunctionNode) and len(m.args.args) == 2 and m.name not in used]
        if "LifecycleNode" in bases:
            for method in hooks:
                near = nearest(method.name, _HOOKS, cutoff=0.75) if method.name not in _HOOKS else None
                if near is not None:
                    yield method.lineno, f"nothing calls {method.name}; did you mean {near}?"
        elif bases == ["Node"] and len(found := [m for m in hooks if m.name in _OWN]) > 1:
            text = f"nothing calls {found[0].name} of a Node: derive {cls.name} from LifecycleNode of rclpy.lifecycle"
            yield found[0].lineno, text
