"""Results that were read before their future was done."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import rclpy
from rclpy.node import Node
from rclpy.task import Future
from tests.rclpy.hinted import hint_of

HEAD = "class Lamp:\n    def tick(self, future):\n        self.future = future\n"
TEXT = (
    "{}.result() (lamp.py:{}) is None until the future is done: write before it: "
    "rclpy.spin_until_future_complete(self, {})"
)


def names_of(tmp_path: Path, source: str) -> dict[str, Any]:
    """The names that a file with that source defines."""
    file = tmp_path / "lamp.py"
    file.write_text(source)
    space: dict[str, Any] = {"__name__": "lamp"}
    exec(compile(source, str(file), "exec"), space)
    return space


def lamp(tmp_path: Path, body: str) -> Any:
    """The class of a file, with that body of its method."""
    return names_of(tmp_path, HEAD + "".join(f"        {line}\n" for line in body.splitlines()))["Lamp"]


def told(tmp_path: Path, body: str, future: object) -> str:
    return hint_of(lambda: lamp(tmp_path, body)().tick(future))


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


def test_a_result_that_is_read_early_in_a_callback(node: Node, tmp_path: Path) -> None:
    """It cannot spin there."""
    made = lamp(tmp_path, "response = future.result()\nresponse.sum")()
    node.create_timer(0.01, lambda: made.tick(Future()))
    assert hint_of(lambda: rclpy.spin_once(node)) == (
        "future.result() (lamp.py:4) is None until the future is done: future.add_done_callback(...), or await it"
    )


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


@pytest.mark.parametrize("returned", ["future.result()", "result"])
def test_a_result_that_a_function_returns_early(tmp_path: Path, returned: str) -> None:
    """The line is named in that function."""
    source = (
        "def ask(client):\n    future = client.call_async(1)\n    result = future.result()\n"
        f"    return {returned}\n\ndef main(client):\n    response = ask(client)\n    print(response.sum)\n"
    )
    space = names_of(tmp_path, source)
    client = SimpleNamespace(call_async=lambda _: Future())
    line = 3 if returned == "result" else 4
    assert hint_of(lambda: space["main"](client)) == (
        f"lamp.py:{line}: future.result() is None there, since nothing spins after line 2; write before it: "
        "rclpy.spin_until_future_complete(node, future)"
    )


@pytest.mark.parametrize("used", ["response.sum", "ask(None).sum"])
def test_the_result_of_a_spin(tmp_path: Path, used: str) -> None:
    """It is none; the line is named, also where a function returns it."""
    source = (
        "def spin_until_future_complete(node, future):\n    pass\n\ndef ask(node):\n    future = 3\n"
        "    response = spin_until_future_complete(node, future)\n    return response\n\ndef main(node):\n"
        f"    response = ask(node)\n    print({used})\n"
    )
    space = names_of(tmp_path, source)
    assert hint_of(lambda: space["main"](None)) == (
        "spin_until_future_complete (lamp.py:6) returns None: write it alone, and then response = future.result()"
    )
