"""What code waits for, read from its frames and its source."""

from __future__ import annotations

import threading
import time
from typing import Any

import pytest

import rclpy
from rclpy.impl.deadlock.blocking import blocked
from rclpy.impl.deadlock.stacks import Level
from rclpy.node import Node
from rclpy.task import Future
from tests.rclpy.stepping import after_a_step


class Own:
    """Code that waits: each method pauses in the middle of what it does."""

    def __init__(self) -> None:
        self.future: Future[int] = Future()
        self.lock = threading.Lock()

    def polls(self) -> Any:
        while not self.future.done():
            yield

    def polls_while_ok(self) -> Any:
        future = self.future
        while rclpy.ok() and not future.done():
            yield

    def looks_and_breaks(self) -> Any:
        future = self.future
        while True:
            yield
            if future.done():
                break

    def has_two_ends(self) -> Any:
        while rclpy.ok():
            yield
            if self.lock.locked():
                break
            if self.future.done():
                break

    def gives_up(self) -> Any:
        until = time.monotonic() + 60
        while rclpy.ok() and not self.future.done() and time.monotonic() < until:
            yield

    def gives_up_in_the_end(self) -> Any:
        while not (self.future.done() or self.lock.locked()):
            yield

    def looks_at_the_clock(self) -> Any:
        until = time.monotonic() + 60
        while True:
            yield
            if self.future.done() or time.monotonic() > until:
                break

    def asks_two(self) -> Any:
        while not (self.future.done() or self.future.done()):
            yield


def wait_of(steps: Any) -> Any:
    return blocked(Level(None, [after_a_step(steps)]))


def test_a_loop_waits_for_the_future_that_it_asks(node: Node) -> None:
    """In its condition, or where it breaks."""
    own = Own()
    for steps in (own.polls(), own.polls_while_ok(), own.looks_and_breaks()):
        assert wait_of(steps).future is own.future


@pytest.mark.parametrize("way", ["has_two_ends", "asks_two", "gives_up", "gives_up_in_the_end", "looks_at_the_clock"])
def test_a_loop_with_more_ends_than_one_waits_for_nothing_known(node: Node, way: str) -> None:
    """Any of them may come."""
    own = Own()
    assert wait_of(getattr(own, way)()).future is None
