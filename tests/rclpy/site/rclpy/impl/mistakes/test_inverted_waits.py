"""Loops that go on for as long as a server is there."""

from __future__ import annotations

import atexit
from pathlib import Path
from typing import Any

import pytest
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts

from rclpy.action import ActionClient, ActionServer
from rclpy.impl.mistakes.inverted_waits import is_reported
from rclpy.node import Node

SOURCE = """\
def inverted(end):
    for _ in range(3):
        client.WAIT(5.0)
    while client.WAIT(timeout_sec=5.0):
        print(end())


def right():
    for _ in range(3):
        while not client.WAIT(timeout_sec=5.0):
            print("waiting")
"""


class Enough(Exception):
    """Ends a loop."""


@pytest.mark.parametrize("word", ["wait_for_service", "wait_for_server"])
def test_a_loop_that_lacks_its_not(
    node: Node, tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch, word: str
) -> None:
    """It is told in the second round, and again when the program ends; a wait that is repeated elsewhere is not."""
    at_exit: list[Any] = []
    monkeypatch.setattr(atexit, "register", lambda fn, *args: at_exit.append((fn, args)))
    if word == "wait_for_service":
        node.create_service(AddTwoInts, "add", lambda request, response: response)
        client: Any = node.create_client(AddTwoInts, "add")
    else:
        ActionServer(node, Fibonacci, "count", lambda goal: Fibonacci.Result())
        client = ActionClient(node, Fibonacci, "count")
    file = tmp_path / "program.py"
    file.write_text(SOURCE.replace("WAIT", word))
    space: dict[str, Any] = {"client": client}
    exec(compile(file.read_text(), str(file), "exec"), space)
    space["right"]()
    assert caplog.messages == []
    rounds: list[int] = []

    def end() -> None:
        rounds.append(len(caplog.messages))
        if len(rounds) == 4:
            raise Enough

    with pytest.raises(Enough):
        space["inverted"](end)
    assert rounds == [0, 1, 1, 1]
    way = f"write while not client.{word}(timeout_sec=5.0):"
    text = f"{file}:4: this loop goes on for as long as client.{word} finds a server; {way}"
    assert caplog.messages[0].endswith(text.removeprefix(f"{tmp_path}/"))
    assert is_reported(space["inverted"].__code__)
    ((tell, words),) = at_exit
    tell(*words)
    assert caplog.messages[1] == caplog.messages[0]
