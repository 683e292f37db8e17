"""What code waits for, read from its frames and its source."""

from __future__ import annotations

import sys
import threading
from types import FrameType
from typing import Any

import pytest

import rclpy
from rclpy.impl.blocking import blocked, holds, is_only_entered
from rclpy.impl.stacks import Level
from rclpy.node import Node
from rclpy.task import Future


class Own:
    """Code that waits: each method returns its frame in the middle of what it does."""

    def __init__(self) -> None:
        self.future: Future[int] = Future()
        self.lock, self.other, self.shown = threading.Lock(), threading.Lock(), threading.RLock()

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

    def enters(self) -> Any:
        with self.lock:
            yield sys._getframe()
        yield sys._getframe()

    def is_inside_on_one_line(self) -> Any:
        # fmt: off
        with self.lock: yield sys._getframe()  # noqa: E701 - that is the case
        # fmt: on

    def takes(self) -> None:
        self.other.acquire()

    def shows(self) -> Any:
        return self.shown


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


def test_on_one_line_nobody_knows_who_enters_and_who_is_inside() -> None:
    """So it is nobody who waits."""
    assert wait_of(next(Own().is_inside_on_one_line())).lock == ""


def test_who_is_inside_a_lock() -> None:
    """From its first line to its last."""
    own = Own()
    inside = own.enters()
    frame = next(inside)
    assert holds(frame, "lock", own)
    assert not holds(frame, "other", own)
    assert not holds(frame, "lock", Own())
    assert not holds(next(inside), "lock", own)


def test_locks_that_others_may_release() -> None:
    """By a method, or since they are known elsewhere."""
    own = Own()
    assert is_only_entered("lock", own) is False  # has_two_ends passes it on to no one, but asks it
    assert is_only_entered("other", own) is False
    assert is_only_entered("shown", own) is False


class Plain:
    def __init__(self) -> None:
        self.guard = threading.Lock()

    def work(self) -> None:
        with self.guard:
            return


def test_a_lock_that_is_only_entered() -> None:
    """It is released where its block ends, and nowhere else."""
    assert is_only_entered("guard", Plain())


def test_code_that_waits_for_a_lock_is_where_it_enters() -> None:
    """As soon as it stands there."""
    own, seen = Own(), threading.Event()

    def enter() -> None:
        seen.set()
        next(own.enters())

    with own.lock:
        thread = threading.Thread(target=enter)
        thread.start()
        assert seen.wait(10.0)
        found = ""
        while not found:
            frame = sys._current_frames()[thread.ident or 0]
            found = wait_of(frame).lock
    thread.join(10.0)
    assert found == "lock"
