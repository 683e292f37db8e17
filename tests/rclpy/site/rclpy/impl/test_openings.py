"""What makes a server that is waited for, read from programs as they stand in one line."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from types import FrameType
from typing import Any

import pytest
from std_srvs.srv import Trigger

import rclpy
from rclpy.impl.openings import Opening, opening_of, tries_forever
from rclpy.impl.subjects import Subject
from rclpy.node import Node


class Offers(Node):
    """Each generator yields its frame in the line in which it waits."""

    def __init__(self) -> None:
        super().__init__("offers")

    def later(self) -> Iterator[FrameType]:
        yield sys._getframe()
        self.create_service(Trigger, "own", print)

    def on_timer(self) -> None:
        self.make()

    def make(self) -> None:
        self.create_service(Trigger, "made", print)

    def either(self) -> Iterator[FrameType]:
        if self.get_name():
            yield sys._getframe()
        else:
            self.create_service(Trigger, "either", print)

    def before(self) -> Iterator[FrameType]:
        self.create_service(Trigger, "before", print)
        yield sys._getframe()

    def tries(self, client: Any) -> Iterator[FrameType]:
        while not client.wait_for_service(1.0):
            yield sys._getframe()

    def tries_while_ok(self, client: Any) -> Iterator[FrameType]:
        while rclpy.ok() and not client.wait_for_service(1.0):
            yield sys._getframe()
            if not rclpy.ok():
                return

    def tries_and_leaves(self, client: Any) -> Iterator[FrameType]:
        while not client.wait_for_service(1.0):
            yield sys._getframe()
            if self.get_name():
                break

    def tries_three_times(self, client: Any) -> Iterator[FrameType]:
        count = 0
        while not client.wait_for_service(1.0) and count < 3:
            yield sys._getframe()


class Absent:
    """A client of a service that is not there."""

    def wait_for_service(self, timeout_sec: float) -> bool:
        return False


def opening(node: Node, service: str, frame: FrameType | None = None, *others: Any) -> Opening | None:
    subject: Any = Subject(node, ["on_timer"])
    return opening_of(service, [sys._getframe() if frame is None else frame], subject, others, [__file__])


@pytest.fixture
def offers(network: object) -> Offers:
    """A node of that class."""
    rclpy.init()
    return Offers()


def test_code_that_comes_after(offers: Offers) -> None:
    """In the same function, on the same way through it, and under the name that it resolves to."""
    later, either, before = offers.later(), offers.either(), offers.before()
    assert opening(offers, "/own", next(later)) == Opening(frozenset(), True)
    assert opening(offers, "/other/own", next(offers.later())) is None
    assert opening(offers, "/either", next(either)) is None
    assert opening(offers, "/before", next(before)) is None


def test_a_callback_that_makes_it(offers: Offers) -> None:
    """By way of another method; not where another node may, or nobody is seen to."""
    assert opening(offers, "/made") == Opening(frozenset({"on_timer"}), False)
    assert opening(offers, "/elsewhere/made") is None
    assert opening(offers, "/nobody") is None


@pytest.mark.parametrize(
    ("way", "is_endless"),
    [
        (Offers.tries, True),
        (Offers.tries_while_ok, True),
        (Offers.tries_and_leaves, False),
        (Offers.tries_three_times, False),
    ],
)
def test_loops(offers: Offers, way: Any, is_endless: bool) -> None:
    """One that tries until there is a server or the program ends, and others."""
    code = way(offers, Absent())
    assert tries_forever(next(code)) is is_endless
