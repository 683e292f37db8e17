"""Results that were read before their future was done."""

from __future__ import annotations

from pathlib import Path

import pytest

from rclpy.task import Future
from tests.rclpy.hinted import hint_of

HEAD = "class Lamp:\n    def tick(self, future):\n        self.future = future\n"
TEXT = "{}.result() (lamp.py:{}) is None until the future is done: {}.add_done_callback(...), or await it"


def told(tmp_path: Path, body: str, future: object) -> str:
    file = tmp_path / "lamp.py"
    file.write_text(source := HEAD + "".join(f"        {line}\n" for line in body.splitlines()))
    space: dict[str, object] = {"__name__": "lamp"}
    exec(compile(source, str(file), "exec"), space)
    return hint_of(lambda: space["Lamp"]().tick(future))  # type: ignore[operator]


@pytest.mark.parametrize(
    ("body", "path", "line"),
    [
        ("response = future.result()\nprint(f'sum {response.sum}')", "future", 4),
        ("self.got = self.future.result()\nprint(1)\nself.got.sum", "self.future", 4),
    ],
)
def test_a_result_that_is_read_early(tmp_path: Path, body: str, path: str, line: int) -> None:
    """The line is named that reads it."""
    assert told(tmp_path, body, Future()) == TEXT.format(path, line, path)


@pytest.mark.parametrize(
    "body",
    [
        "response = future.result()\nother = None\nother.sum",
        "response = None\nresponse.sum\nresponse = future.result()",
        "response = {}.get(1)\nresponse.sum",
    ],
)
def test_other_values_that_are_none(tmp_path: Path, body: str) -> None:
    """Nothing is told of them."""
    assert told(tmp_path, body, Future()) == ""


def test_a_result_that_is_none(tmp_path: Path) -> None:
    """Nothing is told of a future that is done."""
    future: Future[None] = Future()
    future.set_result(None)
    assert told(tmp_path, "response = future.result()\nresponse.sum", future) == ""
