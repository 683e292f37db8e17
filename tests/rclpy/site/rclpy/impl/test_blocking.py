"""What code waits for, read from its frames and its source."""

from __future__ import annotations

import sys
import threading
from types import FrameType
from typing import Any

import pytest

import rclpy
from rclpy.impl.blocking import blocked
from rclpy.impl.stacks import Level
from rclpy.node import Node
from rclpy.task import Future


class Own:
    """Code that waits: each method returns its frame in the middle of what it does."""

    def __init__(self) -> None:
        self.future: Future[int] = Future()
        self.lock = threading.Lock()

    def polls(self) -> Any:
        while not self.future.done():
            return sys._getframe()

    def polls_while_ok(self) -> Any:
        future = self.future
        while rclpy.ok() and not future.done():
            frame = sys._getframe()
            if frame:
                yield frame

    def looks_and_breaks(self) -> Any:
        future = self.future
        while True:
            yield sys._getframe()
            if future.done():
                break

    def has_two_ends(self) -> Any:
        while rclpy.ok():
            yield sys._getframe()
            if self.lock.locked():
                break
            if self.future.done():
                break

    def asks_two(self) -> Any:
        while not (self.future.done() or self.future.done()):
            yield sys._getframe()


def wait_of(frame: FrameType) -> Any:
    return blocked(Level(None, [frame]))


def test_a_loop_waits_for_the_future_that_it_asks(node: Node) -> None:
    """In its condition, or where it breaks."""
    own = Own()
    for frame in (next(own.polls_while_ok()), next(own.looks_and_breaks())):
        assert wait_of(frame).future is own.future


@pytest.mark.parametrize("way", ["polls", "has_two_ends", "asks_two"])
def test_a_loop_with_more_ends_than_one_waits_for_nothing_known(node: Node, way: str) -> None:
    """Any of them may come."""
    own = Own()
    found = getattr(own, way)()
    assert wait_of(found if way == "polls" else next(found)).future is None
