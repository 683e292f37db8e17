"""Waits in `on_start` for what only a handler sets; `test_foreseen` has the cases."""

from __future__ import annotations

import ast

import pytest

from graphflow import Node, subscription
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.mistakes.source.early_waits import early_waits


class Robot(Node):
    pose: String | None = None
    ready = True

    @subscription(String, "pose")
    async def on_pose(self, pose: String) -> None:
        self.pose, self.ready = pose, False


def _told(test: str) -> list[int]:
    lines = (
        "class Robot:",
        "    async def on_start(self):",
        f"        while {test}:",
        "            await self.clock.sleep(1)",
    )
    definition = ast.parse("\n".join(lines)).body[0]
    assert isinstance(definition, ast.ClassDef)
    return [line for line, _ in early_waits(Robot, definition)]


@pytest.mark.parametrize(
    ("test", "lines"),
    [
        ("self.pose is None", [3]),
        ("not self.pose", [3]),
        ("self.pose is None and self.name", []),
        ("self.ready", []),
        ("not self.ready", []),
        ("True", []),
        ("pose is None", []),
    ],
)
def test_the_condition_decides(test: str, lines: list[int]) -> None:
    """Only one that holds at the start, and that reads nothing but the attribute."""
    assert _told(test) == lines
