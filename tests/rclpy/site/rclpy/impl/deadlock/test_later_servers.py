"""What makes a server that is waited for, read from programs as they stand in one line."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any

import pytest
from std_srvs.srv import Trigger

import rclpy
from graphflow.analysis.frames import Frame, running
from rclpy.impl.deadlock.later_servers import Opening, comes_after, opening_of, tries_forever
from rclpy.impl.deadlock.subjects import Subject
from rclpy.node import Node
from tests.rclpy.stepping import after_a_step


class Offers(Node):
    """Each generator pauses in the line in which it waits."""

    def __init__(self) -> None:
        super().__init__("offers")

    def later(self) -> Iterator[None]:
        yield
        self.create_service(Trigger, "own", print)

    def on_timer(self) -> None:
        self.make()

    def make(self) -> None:
        self.create_service(Trigger, "made", print)

    def either(self) -> Iterator[None]:
        if self.get_name():
            yield
        else:
            self.create_service(Trigger, "either", print)

    def before(self) -> Iterator[None]:
        self.create_service(Trigger, "before", print)
        yield

    def tries(self, client: Any) -> Iterator[None]:
        while not client.wait_for_service(1.0):
            yield

    def tries_while_ok(self, client: Any) -> Iterator[None]:
        while rclpy.ok() and not client.wait_for_service(1.0):
            yield
            if not rclpy.ok():
                return

    def tries_and_leaves(self, client: Any) -> Iterator[None]:
        while not client.wait_for_service(1.0):
            yield
            if self.get_name():
                break

    def tries_three_times(self, client: Any) -> Iterator[None]:
        count = 0
        while not client.wait_for_service(1.0) and count < 3:
            yield


class Absent:
    """A client of a service that is not there."""

    def wait_for_service(self, timeout_sec: float) -> bool:
        return False


def opening(node: Node, service: str, frame: Frame | None = None, *others: Any) -> Opening | None:
    subject: Any = Subject(node, ["on_timer"])
    return opening_of(service, [running(sys._getframe()) if frame is None else frame], subject, others, [__file__])


@pytest.fixture
def offers(network: object) -> Offers:
    """A node of that class."""
    rclpy.init()
    return Offers()


def test_code_that_comes_after(offers: Offers) -> None:
    """In the same function, on the same way through it, and under the name that it resolves to."""
    later, either, before = offers.later(), offers.either(), offers.before()
    assert opening(offers, "/own", after_a_step(later)) == Opening(frozenset(), True)
    assert opening(offers, "/other/own", after_a_step(offers.later())) is None
    assert opening(offers, "/either", after_a_step(either)) is None
    assert opening(offers, "/before", after_a_step(before)) is None


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
    assert tries_forever(after_a_step(code)) is is_endless


class Late(Node):
    """Waits in its `__init__`, before it offers."""

    def __init__(self) -> None:
        super().__init__("late")
        self.create_service(Trigger, "first", print)
        self.said = comes_after([running(sys._getframe())])
        self.create_service(Trigger, "second", print)
        self.create_service(Trigger, "third", print)
        self.last = comes_after([running(sys._getframe())])

    def elsewhere(self) -> str:
        said = comes_after([running(sys._getframe())])
        self.create_service(Trigger, "fourth", print)
        return said


def test_servers_that_come_after_a_wait(node: Node) -> None:
    """Are told with the line of the first, where it is an `__init__` that waits; those before it are not."""
    late = Late()
    place = f"test_later_servers.py:{Late.__init__.__code__.co_firstlineno + 4}"
    way = "are offered only after this wait: offer first, or wait outside of __init__"
    assert late.said == f"; second ({place}) and 1 more {way}"
    assert late.last == late.elsewhere() == ""
