"""Locks that code waits for, and who is inside of them."""

from __future__ import annotations

import threading
from typing import Any

import pytest

from graphflow.analysis.frames import stack_of
from rclpy.impl.deadlock.locks import Entering, entered_at, is_inside, is_kept
from tests.rclpy.locking import WHOSE, Bank
from tests.rclpy.stepping import after_a_step


@pytest.mark.parametrize(
    ("way", "lock"),
    [
        ("enters", lambda bank: bank.first),
        ("enters_part", lambda bank: bank.account.lock),
        ("enters_what_all_have", lambda bank: bank.shared),
        ("enters_what_all_have", lambda bank: WHOSE),
        ("acquires", lambda bank: bank.first),
    ],
)
def test_who_is_inside(way: str, lock: Any) -> None:
    """From the first line to the last; another object's lock is another."""
    bank = Bank()
    steps = getattr(bank, way)()
    frame = after_a_step(steps)
    others = Bank().first
    assert is_inside(frame, lock(bank))
    assert not is_inside(frame, others)
    assert not is_inside(after_a_step(steps), lock(bank))


@pytest.mark.parametrize("way", ["takes_signal", "tries"])
def test_who_may_be_inside_or_not(way: str) -> None:
    """What is not released there, or was perhaps not acquired."""
    bank = Bank()
    frame = after_a_step(getattr(bank, way)())
    for value in vars(bank).values():
        assert not is_inside(frame, value)


def test_a_body_on_the_same_line() -> None:
    """The column tells who is inside."""
    bank = Bank()
    frame = after_a_step(bank.is_inside_on_one_line())
    assert entered_at(frame) is None
    assert is_inside(frame, bank.first)


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("self.first", True),
        ("self.account.lock", True),
        ("self.signal", False),
        ("self.given", False),
        ("self.loose", False),
        ("self.shown", False),
    ],
)
def test_locks_that_others_may_release(text: str, kept: bool) -> None:
    """By a method that has not acquired it, or since it is known elsewhere."""
    frame = after_a_step(Bank().enters())
    assert is_kept(Entering(object(), text), [frame]) is kept


@pytest.mark.parametrize("way", ["enters", "acquires", "enters_part", "is_inside_on_one_line"])
def test_code_that_waits_is_where_it_enters(way: str) -> None:
    """As soon as it stands there."""
    bank, seen = Bank(), threading.Event()
    lock = bank.account.lock if way == "enters_part" else bank.first

    def enter() -> None:
        seen.set()
        steps = getattr(bank, way)()
        next(steps)
        steps.close()

    with lock:
        thread = threading.Thread(target=enter)
        thread.start()
        assert seen.wait(10.0)
        while (found := entered_at(stack_of(thread.ident or 0)[-1])) is None:
            assert thread.is_alive()
    thread.join(10.0)
    assert found.lock is lock
    assert found.text == {"enters_part": "account.lock"}.get(way, "self.first")
