"""Goals that a line has made, and not sent."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import Place
from graphflow.runtime.mistakes.unsent import sending_line


@pytest.mark.parametrize(
    ("line", "way"),
    [
        ("goal = self.count.send(Goal(order=4))", "write goal = await self.count.send_goal(Goal(order=4)), in m.py:1"),
        (
            "self.goal = self.count.send(goal, timeout=1.0)",
            "write self.goal = await self.count.send_goal(goal, timeout=1.",
        ),
        ("self.keep(self.count.send(goal))", "write `async with client.send(goal) as sent:`"),
        ("goal = self.count.send(", "write `async with client.send(goal) as sent:`"),
    ],
)
def test_a_line(tmp_path: Path, line: str, way: str) -> None:
    """It is told as it has to be, if it is an assignment on one line."""
    file = tmp_path / "m.py"
    file.write_text(f"{line}\n")
    assert sending_line(Place(str(file), 1)).startswith(way)
