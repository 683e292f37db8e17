"""Blocks of goals that wait for nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import Place
from graphflow.runtime.mistakes.left_early import left_early


def _told(tmp_path: Path, number: int, body: str, first: str = "async with self.fib.send(Goal()) as sent:") -> str:
    file = tmp_path / f"left_{number}.py"
    lines = "".join(f"        {line}\n" for line in body.splitlines())
    file.write_text(f"async def go(self):\n    {first}\n{lines}")
    place = Place(str(file), 2)
    said = left_early(place)
    assert left_early(place) == ""
    return said.replace(str(file), "left.py")


def test_a_block_that_waits_for_nothing(tmp_path: Path) -> None:
    """Is told once, with the name of its goal."""
    assert _told(tmp_path, 0, "self.log.info('sent')") == (
        "left.py:2: the block ends at once, which cancels its goal; write await sent.result() in the block, or send "
        "with detach=True to let the goal go on"
    )
    assert "await goal.result()" in _told(tmp_path, 1, "pass", "async with self.fib.send(Goal()):")


@pytest.mark.parametrize(
    "body",
    [
        "await sent.result()",
        "await self.clock.sleep(5.0)",
        "async for feedback in sent.feedback():\n    break",
        "await sent.cancel()",
        "async with self.fib.send(Goal()) as other:\n    await other.result()",
        "yield sent",
        "raise ValueError('not now')",
    ],
)
def test_blocks_that_may_cancel_on_purpose(tmp_path: Path, body: str) -> None:
    """Are not told: those that wait, for whatever."""
    assert _told(tmp_path, hash(body), body) == ""


def test_no_block_in_the_line(tmp_path: Path) -> None:
    """Is not told: the block may be anywhere."""
    assert _told(tmp_path, 0, "pass", "if sending := self.fib.send(Goal()):") == ""
    assert left_early(Place("<string>", 1)) == ""
