"""Names that are meant for a method that the node itself calls."""

from __future__ import annotations

import pytest

from graphflow import LifecycleNode, Node
from graphflow.runtime.mistakes.hooks import hook_meant


class Lamp(Node):
    """Has no life cycle."""


class Camera(LifecycleNode):
    """Has one."""


@pytest.mark.parametrize(
    ("cls", "name", "way"),
    [
        (Camera, "on_configured", "did you mean on_configure?"),
        (Camera, "on_active", "did you mean on_activate?"),
        (Lamp, "on_begin", "did you mean on_start?"),
        (Lamp, "on_exit", "did you mean on_shutdown?"),
        (Lamp, "on_left", ""),
        (Lamp, "on_activate", "derive Lamp from LifecycleNode, whose nodes are configured and activated, or write on_"),
    ],
)
def test_a_name(cls: type, name: str, way: str) -> None:
    """The method that is meant is told, or the class that has it."""
    assert hook_meant(cls, name).startswith(way)
    assert bool(hook_meant(cls, name)) is bool(way)
