"""Callbacks that a subclass hides by one of the same name, which it gives to an entity of its own."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from geometry_msgs.msg import Point, Twist
from std_srvs.srv import Trigger

import rclpy
from rclpy.impl.mistakes import hidden_callbacks
from rclpy.node import Node

Caplog = pytest.LogCaptureFixture
FILE = "test_hidden_callbacks.py"


class Base(Node):
    """A controller that steers by the pose that it has heard last."""

    def __init__(self) -> None:
        super().__init__("base")
        self.pose = Point()
        self.create_subscription(Point, "pose", self.heard, 10)
        self.timer = self.create_timer(10.0, self.tick)
        self.create_service(Trigger, "enable", self.called)
        self.create_subscription(Twist, "any", self.stub, 10)

    def heard(self, msg: Any) -> None:
        self.pose = msg

    def tick(self) -> None:
        self.get_logger().debug(str(self.pose.x))

    def called(self, request: Any, response: Any) -> Any:
        response.success = request is not None
        return response

    def stub(self, msg: Any) -> None:
        raise NotImplementedError


class Topics(Base):
    """One that follows another turtle, by a callback of the same name."""

    def __init__(self) -> None:
        super().__init__()
        self.create_subscription(Point, "goal", self.heard, 10)
        self.create_subscription(Point, "goal2", self.heard, 10)

    def heard(self, msg: Any) -> None:
        self.goal = msg


class Types(Base):
    """One that hears messages of another type, and leaves alone what its base has kept."""

    def __init__(self) -> None:
        super().__init__()
        self.create_subscription(Twist, "goal", self.heard, 10)

    def heard(self, msg: Any) -> None:
        self.pose = msg.linear


class Timers(Base):
    """One that has a timer of its own."""

    def __init__(self) -> None:
        super().__init__()
        self.create_timer(5.0, self.tick)

    def tick(self) -> None:
        """Do nothing."""


class Services(Base):
    """One whose service is another."""

    def __init__(self) -> None:
        super().__init__()
        self.create_service(Trigger, "enable2", self.called)
        self.create_subscription(Point, "goal", self.called, 10)

    def called(self, request: Any, response: Any = None) -> Any:
        return response


class Plain(Base):
    """One that overrides, and subscribes nothing itself."""

    def __init__(self) -> None:
        super().__init__()
        self.create_subscription(Point, "goal", lambda msg: self.heard(msg), 10)

    def heard(self, msg: Any) -> None:
        self.goal = msg


class Extended(Base):
    """One whose callbacks go on with those of its base."""

    def __init__(self) -> None:
        super().__init__()
        self.create_subscription(Point, "goal", self.heard, 10)
        self.create_timer(5.0, self.tick)

    def heard(self, msg: Any) -> None:
        super().heard(msg)

    def tick(self) -> None:
        Base.tick(self)


class Both(Base):
    """One callback for two topics of one type, which keeps what its base's has kept; and a stub that is filled in."""

    def __init__(self) -> None:
        super().__init__()
        self.create_subscription(Point, "goal", self.heard, 10)
        self.create_subscription(Point, "other", self.stub, 10)

    def heard(self, msg: Any) -> None:
        self.pose = self.last = msg

    def stub(self, msg: Any) -> None:
        self.pose = msg


class Anew(Base):
    """One that ends its base's timer, and has another in its place."""

    def __init__(self) -> None:
        super().__init__()
        self.timer.cancel()
        self.timer = self.create_timer(5.0, self.tick)

    def tick(self) -> None:
        """Do nothing."""


class Inherited(Base):
    """One that gives what it has inherited to a topic of its own."""

    def __init__(self) -> None:
        super().__init__()
        self.create_subscription(Point, "goal", self.heard, 10)


@pytest.fixture(autouse=True)
def ros() -> Iterator[None]:
    """rclpy, and nothing told as yet."""
    hidden_callbacks._reported.clear()
    rclpy.init()
    yield
    rclpy.shutdown()


def line_of(method: Any) -> int:
    return int(method.__code__.co_firstlineno)


@pytest.mark.parametrize(
    ("cls", "name", "use", "what"),
    [
        (Topics, "heard", "is subscribed to /pose", "both topics"),
        (Types, "heard", "is subscribed to /pose", "both topics"),
        (Timers, "tick", "is called every 10 s", "both timers"),
        (Services, "called", "answers /enable", "both"),
    ],
)
def test_callbacks_that_are_hidden(cls: type[Node], name: str, use: str, what: str, caplog: Caplog) -> None:
    """Told once, with both methods and what the hidden one was for."""
    node = cls()  # type: ignore[call-arg]
    own, its = (f"{FILE}:{line_of(getattr(c, name))}" for c in (cls, Base))
    assert caplog.messages == [
        f"{cls.__name__}.{name} ({own}) hides Base's ({its}), which {use}; {what} call {cls.__name__}'s: "
        "give it another name"
    ]
    node.destroy_node()


@pytest.mark.parametrize("cls", [Base, Plain, Extended, Both, Anew, Inherited])
def test_callbacks_that_are_overridden(cls: type[Node], caplog: Caplog) -> None:
    """What is meant to be overridden is not told."""
    node = cls()  # type: ignore[call-arg]
    assert caplog.messages == []
    node.destroy_node()
