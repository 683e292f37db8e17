"""Lifecycle hooks that nothing calls."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.lifecycle_hooks import lifecycle_hooks

SOURCE = """
class Lc({base}):
    def {first}(self, state):
        return super().on_configure(state)

    def on_activate(self, state):
        {body}
"""


def _found(base: str, first: str, body: str = "pass") -> list[tuple[int, str]]:
    return list(lifecycle_hooks(ast.parse(SOURCE.format(base=base, first=first, body=body))))


def test_a_misspelt_hook() -> None:
    """The hook that was meant is suggested."""
    assert _found("LifecycleNode", "on_configured") == [(3, "nothing calls on_configured; did you mean on_configure?")]


def test_a_class_that_derives_from_node() -> None:
    """The base class is named, once."""
    text = "nothing calls on_configure of a Node: derive Lc from LifecycleNode of rclpy.lifecycle"
    assert _found("Node", "on_configure") == [(3, text)]


@pytest.mark.parametrize(
    ("base", "first", "body"),
    [
        ("LifecycleNode", "on_configure", "pass"),
        ("LifecycleNode", "on_pose", "pass"),
        ("LifecycleNode", "on_configured", "self.on_configured(state)"),
        ("Node", "on_pose", "pass"),
        ("Node", "on_shutdown", "pass"),
        ("Plugin", "on_configure", "pass"),
        ("Node, Managed", "on_configure", "pass"),
    ],
)
def test_other_methods(base: str, first: str, body: str) -> None:
    """Right hooks, methods that are called, names of other uses, and classes with other bases are left alone."""
    assert _found(base, first, body) == []


@pytest.mark.parametrize(("base", "first"), [("LifecycleNode", "on_configured"), ("Node", "on_configure")])
def test_methods_without_a_state(base: str, first: str) -> None:
    """They are no hooks, whatever they are called."""
    source = SOURCE.replace("(self, state)", "(self)").format(base=base, first=first, body="pass")
    assert not list(lifecycle_hooks(ast.parse(source)))
