"""Publishers, timers and the like that one line makes again and again."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
from std_msgs.msg import String
from std_srvs.srv import Trigger

from rclpy.impl.mistakes import repeats
from rclpy.impl.mistakes.repeats import MANY, MANY_APART, MANY_SUBSCRIPTIONS
from rclpy.node import Node
from rclpy.subscription import Subscription
from tests.rclpy.conftest import Spinner

Caplog = pytest.LogCaptureFixture


def told(caplog: Caplog) -> list[str]:
    return [r.getMessage() for r in caplog.records if " created in " in r.getMessage()]


def nothing(*_: object) -> None:
    """Be called."""


def test_what_a_callback_makes(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """Told once, of each kind with its name and line."""
    runs = []

    def tick() -> None:
        runs.append(node.create_publisher(String, "chat", 10))
        node.create_client(Trigger, "switch")
        node.create_timer(10.0, lambda: None)

    node.create_timer(0.001, tick)
    spin(lambda: len(runs) > MANY + 5)
    first, line = "test_repeats.py:", tick.__code__.co_firstlineno
    way = "create one in __init__, and keep it in an attribute"
    assert told(caplog) == [
        f"/node has 5 timers of <lambda> created in {first}{line + 3}: {way}; one that should run once cancels itself: "
        "timer = self.create_timer(10, lambda: (timer.cancel(), ...))",
        f"/node has 10 publishers of /chat created in {first}{line + 1}: {way}",
        f"/node has 10 clients of /switch created in {first}{line + 2}: {way}",
    ]


def test_timers_that_cancel_themselves(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """Their variable has no value yet while they are made, however many of them wait."""
    runs: list[float] = []

    def tick() -> None:
        def once() -> None:
            timer.cancel()
            runs.append(0.2)

        timer = node.create_timer(0.2, once)

    node.create_timer(0.005, tick)
    spin(lambda: len(runs) > MANY)
    assert len(told(caplog)) <= 1


def test_timers_that_a_constructor_makes(node: Node, caplog: Caplog) -> None:
    """They are as many as it wants, also of one callback."""

    class Fleet(Node):
        def __init__(self) -> None:
            super().__init__("fleet")
            for number in range(MANY + 2):
                self.create_timer(10.0 + number, self.beat)

        def beat(self) -> None: ...

    Fleet()
    assert told(caplog) == []


def test_a_timer_that_runs_once(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """The way is written with its callback, and works."""
    runs: list[str] = []

    class Delays(Node):
        def __init__(self) -> None:
            super().__init__("delays")
            self.create_timer(0.001, self.tick)

        def tick(self) -> None:
            self.create_timer(10.0, self.answer)

        def answer(self) -> None:
            runs.append("answer")

    self = Delays()
    spin.executor.add_node(self)
    spin(lambda: told(caplog))
    [text] = told(caplog)
    assert text.endswith("timer = self.create_timer(10, lambda: (timer.cancel(), self.answer()))")
    known: dict[str, Any] = {"self": self}
    exec(text.rpartition("itself: ")[2].replace("10", "0.001"), known)
    spin(lambda: known["timer"].is_canceled())
    assert runs == ["answer"]


def test_a_callback_that_subscribes_again(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """It soon handles each message three times, which is told; different callbacks may share a topic."""
    for number in range(MANY_SUBSCRIPTIONS + 1):
        node.create_subscription(String, "chat", partial(nothing, number), 10)
    assert told(caplog) == []

    def subscribe() -> None:
        node.create_subscription(String, "news", nothing, 10)

    subscribe()
    subscribe()
    assert told(caplog) == []
    subscribe()
    place = f"test_repeats.py:{subscribe.__code__.co_firstlineno + 1}"
    way = "create one in __init__, and keep it in an attribute"
    assert told(caplog) == [f"/node has 3 subscriptions of /news created in {place}: {way}"]


def test_what_is_many_by_right(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """Those of other names, those that are destroyed or cancelled, and timers of a loop are not told."""
    for number in range(MANY + 5):
        node.create_publisher(String, f"chat{number}", 10)
        node.create_timer(10.0, lambda: None)
        node.destroy_subscription(node.create_subscription(String, "chat", nothing, 10))
        node.create_timer(10.0, nothing).cancel()
    assert told(caplog) == []


@pytest.mark.parametrize("is_for_one", [True, False])
def test_timers_for_several_things(
    node: Node, spin: Spinner, caplog: Caplog, monkeypatch: pytest.MonkeyPatch, is_for_one: bool
) -> None:
    """Few that have values of their own are meant so; many are not."""
    monkeypatch.setattr(repeats, "_reported", set())
    runs: list[float] = []

    def tick() -> None:
        runs.append(len(runs) + 0.5)
        name = "turtle" if is_for_one else runs[-1]
        node.create_timer(10.0, lambda name=name: nothing(name))

    node.create_timer(0.001, tick)
    spin(lambda: len(runs) > MANY + 5)
    assert len(told(caplog)) == is_for_one
    spin(lambda: len(runs) > MANY_APART)
    assert len(told(caplog)) == 1


def test_two_services_of_one_name(node: Node, caplog: Caplog) -> None:
    """Told once, with both lines; one that was destroyed does not count."""

    def make(name: str) -> None:
        node.create_service(Trigger, name, lambda _, response: response)

    node.destroy_service(node.create_service(Trigger, "switch", lambda _, response: response))
    node.create_service(Trigger, "switch", lambda _, response: response)
    make("/switch")
    make("other")
    make("other")
    line = test_two_services_of_one_name.__code__.co_firstlineno + 7
    inner = make.__code__.co_firstlineno + 1
    texts = [record.getMessage() for record in caplog.records if "twice" in record.getMessage()]
    assert texts == [
        f"/node offers /switch twice, in test_repeats.py:{line} and in test_repeats.py:{inner}: "
        "each call reaches both, and the first answer counts; keep one"
    ]


def test_a_callback_that_is_subscribed_twice(node: Node, caplog: Caplog) -> None:
    """Told once, with both lines; other topics and other callbacks are the user's affair, and so is what is gone."""

    def subscribe(topic: str, callback: Callable[[String], None]) -> Subscription:
        return node.create_subscription(String, topic, callback, 10)

    gone = node.create_subscription(String, "chat", nothing, 10)
    node.destroy_subscription(gone)
    subscribe("chat", nothing)
    subscribe("other", nothing)
    node.create_subscription(String, "chat", lambda _: None, 10)
    assert caplog.messages == []
    node.create_subscription(String, "/chat", nothing, 10)
    file, line = "test_repeats.py:", inspect.currentframe().f_lineno - 1  # type: ignore[union-attr]
    former = subscribe.__code__.co_firstlineno + 1
    assert caplog.messages == [
        f"/node subscribes nothing to /chat twice, in {file}{former} and in {file}{line}: each message is handled "
        "twice; keep one"
    ]
