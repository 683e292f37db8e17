"""Lifecycle nodes of rclpy whose publishers are all plain ones, which send in every state."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import last_name


def unmanaged_publishers(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the first publisher of such a class; it comes with the call that makes a managed one."""
    for cls in ast.walk(module):
        if not isinstance(cls, ast.ClassDef) or not any(last_name(base) == "LifecycleNode" for base in cls.bases):
            continue
        calls = {last_name(node.func): node for node in ast.walk(cls) if isinstance(node, ast.Call)}
        if "create_publisher" in calls and "create_lifecycle_publisher" not in calls:
            text = "this publisher sends in every state of the node; one that sends only while the node is active is"
            yield calls["create_publisher"].lineno, f"{text} create_lifecycle_publisher(...), made in on_configure"
