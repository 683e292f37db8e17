"""A turtle at the arrow keys."""

import asyncio
import io
import os
import sys
import termios
from collections.abc import Callable, Iterator
from typing import TextIO

import pytest

from graphflow import GraphflowError
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.testing import Graph
from nodes.turtle_teleop import TurtleTeleop


@pytest.fixture
def press(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[bytes], int]]:
    """Make standard input a terminal; returns a function that presses keys."""
    pressing, reading = os.openpty()
    stdin: TextIO
    with open(reading) as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        yield lambda keys: os.write(pressing, keys)
    os.close(pressing)


async def until(condition: Callable[[], object]) -> None:
    """Let the loop run until the condition holds."""
    while not condition():
        await asyncio.sleep(0)


async def test_arrows_are_commands(
    press: Callable[[bytes], int], graph: Graph, capsys: pytest.CaptureFixture[str]
) -> None:
    """One press is one command of the scale's size; other keys are none."""
    await graph.start(TurtleTeleop(scale_angular=1.5))
    twists = graph.tap(Twist, "/turtle1/cmd_vel")

    press(b"\x1b[A\x1b[B x\x1b[D\x1b[C")
    await until(lambda: len(twists) == 4)

    assert [(t.linear.x, t.angular.z) for t in twists] == [(2.0, 0.0), (-2.0, 0.0), (0.0, 1.5), (0.0, -1.5)]
    assert twists[0] == Twist(linear=Vector3(x=2.0))
    assert capsys.readouterr().out.splitlines() == [
        "Reading from keyboard",
        "---------------------------",
        "Use arrow keys to move the turtle.",
        "'Q' to quit.",
    ]


@pytest.mark.parametrize("key", [b"q", b"Q"])
async def test_q_ends_it_and_gives_the_terminal_back(press: Callable[[bytes], int], graph: Graph, key: bytes) -> None:
    """Without an error."""
    before = termios.tcgetattr(sys.stdin)
    node = TurtleTeleop()
    await graph.start(node)
    assert termios.tcgetattr(sys.stdin) != before

    press(key)
    await node.wait_ended()

    assert termios.tcgetattr(sys.stdin) == before


async def test_stopping_it_gives_the_terminal_back(press: Callable[[bytes], int], graph: Graph) -> None:
    """As Ctrl-C does, while it waits for a key."""
    before = termios.tcgetattr(sys.stdin)
    node = TurtleTeleop()
    await graph.start(node)

    await graph.stop(node)

    assert termios.tcgetattr(sys.stdin) == before


async def test_without_a_terminal_it_says_what_to_do(
    graph: Graph, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """And fails, so that the process ends with 1."""
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    node = TurtleTeleop()
    await graph.start(node)
    with pytest.raises(GraphflowError, match="no arrow keys, since"):
        await node.wait_ended()

    assert node.name == "teleop_turtle"
    assert any("run teleop_turtle in its own terminal" in m for m in caplog.messages)
