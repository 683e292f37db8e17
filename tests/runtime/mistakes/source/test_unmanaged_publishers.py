"""Plain publishers of lifecycle nodes."""

from __future__ import annotations

import ast

import pytest

from graphflow.runtime.mistakes.source.unmanaged_publishers import unmanaged_publishers

SOURCE = """
class Lamp({base}):
    def on_configure(self, state):
        self.status = self.create_publisher(String, "status", 10)
        {line}
"""


def test_a_node_without_managed_publishers() -> None:
    """The sentence has the call."""
    [(line, text)] = unmanaged_publishers(ast.parse(SOURCE.format(base="LifecycleNode", line="pass")))
    assert line == 4
    assert "create_lifecycle_publisher(...), made in on_configure" in text


@pytest.mark.parametrize(
    ("base", "line"), [("Node", "pass"), ("LifecycleNode", "self.create_lifecycle_publisher(String, 'x', 10)")]
)
def test_other_nodes(base: str, line: str) -> None:
    """A node that also has a managed one has chosen."""
    assert not list(unmanaged_publishers(ast.parse(SOURCE.format(base=base, line=line))))
