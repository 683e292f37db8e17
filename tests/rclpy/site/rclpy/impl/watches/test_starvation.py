"""Callbacks that run for long while others wait, and nodes that nobody spins."""

from __future__ import annotations

import inspect
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

import pytest
from example_interfaces.action import Fibonacci
from std_msgs.msg import String
from std_srvs.srv import Trigger

import rclpy
from graphflow.deadlock.search import Search
from rclpy.action import ActionClient, ActionServer
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.impl.deadlock import waiting
from rclpy.impl.nodes import internals_of
from rclpy.impl.watches import starvation
from rclpy.node import Node
from tests.cases import slow
from tests.rclpy.looking import ManualTime, look
from tests.until import until

Caplog = pytest.LogCaptureFixture
LIMIT = 10.0


@pytest.fixture(autouse=True)
def _soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(starvation, "WARN_AFTER", 0.2)
    monkeypatch.setattr(waiting, "LOOK_EVERY", 0.02)


def told(caplog: Caplog) -> list[str]:
    return [r.getMessage() for r in caplog.records if r.name == "graphflow" and r.levelname == "WARNING"]


@contextmanager
def in_thread(fn: Callable[[], Any]) -> Iterator[None]:
    """Calls `fn` in a thread, whose end is waited for."""
    thread = threading.Thread(target=fn, name="own")
    thread.start()
    try:
        yield
    finally:
        thread.join(LIMIT)
        assert not thread.is_alive()


@contextmanager
def spun(*nodes: Node, executor: Any = None) -> Iterator[Any]:
    """An executor with these nodes, which a thread spins."""
    executor = SingleThreadedExecutor() if executor is None else executor
    for node in nodes:
        executor.add_node(node)

    def spin() -> None:
        while not executor._is_shutdown:
            executor.spin_once(0.05)

    with in_thread(spin):
        try:
            yield executor
        finally:
            executor.shutdown()


class Slow(Node):
    """Its timer runs until it is let go."""

    def __init__(self) -> None:
        super().__init__("slow")
        self.began, self.may_end = threading.Event(), threading.Event()
        self.create_subscription(String, "chat", self.hear, 10)
        self.ticks = self.create_timer(0.01, self.tick)

    def hear(self, message: String) -> None:
        """Be quick."""

    def tick(self) -> None:
        self.began.set()
        self.may_end.wait(LIMIT)
        self.ticks.cancel()


TICK = f"test_starvation.py:{Slow.tick.__code__.co_firstlineno + 2} in tick"


@slow
@pytest.mark.parametrize("threads", [1, 3])
def test_a_callback_that_keeps_others_waiting(node: Node, caplog: Caplog, threads: int) -> None:
    """Told once with the line, and when it is over: those of its executor wait, or those of its group."""
    chat, slow = node.create_publisher(String, "chat", 10), Slow()
    with spun(slow, executor=SingleThreadedExecutor() if threads == 1 else MultiThreadedExecutor(threads)):
        assert slow.began.wait(LIMIT)
        chat.publish(String())
        until(lambda: any("running" in text for text in told(caplog)))
        look(times=5)
        slow.may_end.set()
        until(lambda: any("returned" in text for text in told(caplog)))
    long, over = told(caplog)
    assert long.startswith("timer tick of /slow has been running for ")
    assert f"now in {TICK}, and keeps subscription hear waiting: return from it soon" in long
    way = (
        "and spin with MultiThreadedExecutor()"
        if threads == 1
        else ": these share one, whose callbacks run one at a time"
    )
    assert f"a callback group of its own{' ' if threads == 1 else ''}{way}" in long
    assert over.startswith("timer tick of /slow has returned after ")


def test_a_timer_that_keeps_itself(node: Node, caplog: Caplog) -> None:
    """Is due again before it returns."""
    slow = Slow()
    with spun(slow):
        until(lambda: told(caplog))
        slow.may_end.set()
    assert f"now in {TICK}, and is due again: return from it soon" in told(caplog)[0]
    assert "MultiThreadedExecutor" not in told(caplog)[0]


def test_a_goal_whose_result_is_asked_for(node: Node, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """That waits for the end as it should: nothing is told before a request to cancel waits, or a new goal."""
    monkeypatch.setattr(starvation, "time", clock := ManualTime())
    may_end, server_node = threading.Event(), rclpy.create_node("server")

    def execute(goal_handle: Any) -> Any:
        may_end.wait(LIMIT)
        goal_handle.succeed()
        return Fibonacci.Result()

    server = ActionServer(server_node, Fibonacci, "fib", execute)
    client = ActionClient(node, Fibonacci, "fib")
    with spun(server_node), spun(node):
        try:
            sent: Any = client.send_goal_async(Fibonacci.Goal())
            until(sent.done)
            result = sent.result().get_result_async()
            until(lambda: internals_of(server).results.inbox.items)
            look()
            clock.advance(0.5)
            look()
            assert told(caplog) == []
            sent.result().cancel_goal_async()
            until(lambda: told(caplog))
        finally:
            may_end.set()
        until(result.done)
    text = told(caplog)[0]
    assert text.startswith("action execute of /server has been running for ")
    assert "and keeps a request to cancel waiting: give it a callback group of its own" in text


def test_a_callback_in_a_deadlock(node: Node, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """Is told as that alone; and one for which nothing waits, not at all."""
    asked = []

    def has_reported(self: Search, activity: str, title: str) -> bool:
        asked.append(title)
        return True

    monkeypatch.setattr(Search, "has_reported", has_reported)
    slow = Slow()
    with spun(slow):
        until(lambda: asked)
        slow.may_end.set()
    assert told(caplog) == []
    assert asked[0] == "timer tick of /slow"


class Endless(Node):
    """Does in `__init__` what a timer should do."""

    def __init__(self, may_end: threading.Event) -> None:
        super().__init__("endless")
        while not may_end.wait(0.01):
            self.get_name()


class Listener(Node):
    """Waits for its subscription, and is not spun meanwhile."""

    def __init__(self) -> None:
        super().__init__("listener")
        self.heard: String | None = None
        self.create_subscription(String, "chat", self.hear, 10)

    def hear(self, message: String) -> None:
        self.heard = message

    def wait(self) -> None:
        end = time.monotonic() + LIMIT
        while self.heard is None and time.monotonic() < end:
            time.sleep(0.01)


class Spins(Node):
    """Spins in its timer, and in `__init__` where that is asked for."""

    def __init__(self, *, in_init: bool) -> None:
        super().__init__("spins")
        if in_init:
            rclpy.spin(self)
        self.create_timer(0.01, self.tick)

    def tick(self) -> None:
        rclpy.spin(self)


def test_a_callback_that_spins(network: Any, caplog: Caplog) -> None:
    """Keeps its group: told with the line."""
    rclpy.init()
    node = Spins(in_init=False)
    with in_thread(lambda: until_shut_down(lambda: rclpy.spin(node))):
        until(lambda: told(caplog))
        rclpy.shutdown()
    [text] = told(caplog)
    line = Spins.tick.__code__.co_firstlineno + 1
    assert f", now in test_starvation.py:{line} in tick, and is due again: it spins there; let it return" in text


def test_an_init_that_spins(network: Any, caplog: Caplog) -> None:
    """Told with the line, if it comes before there is anything to be called."""
    rclpy.init()
    with in_thread(lambda: until_shut_down(lambda: Spins(in_init=True))):
        until(lambda: told(caplog))
        rclpy.shutdown()
    [text] = told(caplog)
    line = Spins.__init__.__code__.co_firstlineno + 3
    assert text.startswith(f"Spins.__init__ does not return: it spins in test_starvation.py:{line} in __init__, and ")
    assert text.endswith("call rclpy.spin(node) after it")


def until_shut_down(fn: Callable[[], object]) -> None:
    """Call what spins, to the end of the context."""
    with suppress(ExternalShutdownException):
        fn()


def test_an_init_that_does_not_return(node: Node, caplog: Caplog) -> None:
    """Is told with its class and the line, whether something waits for it or not."""
    may_end = threading.Event()
    with in_thread(lambda: Endless(may_end)):
        until(lambda: told(caplog))
        may_end.set()
    [text] = told(caplog)
    assert text.startswith("Endless.__init__ has not returned for ")
    assert "test_starvation.py:" in text
    assert "no callback of /endless is called before rclpy.spin(node): make a timer in __init__" in text


def test_a_node_that_nobody_spins(node: Node, caplog: Caplog) -> None:
    """Told with what should have been called, and where the program is; and that it is spun."""
    node.create_timer(0.01, lambda: None)
    until(lambda: told(caplog))
    with spun(node):
        until(lambda: len(told(caplog)) > 1)
    text, over = told(caplog)
    assert text.startswith(f"/{node.get_name()} has not been spun for ")
    assert "timer <lambda> should be called: the program is in until.py:" in text
    assert text.endswith("; call rclpy.spin_once(node, timeout_sec=0.1) in the loop there, in place of a sleep")
    assert over.startswith("/node is spun after ")


def test_a_program_that_waits_for_a_callback(node: Node, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """It polls what a callback sets: told, although no message has come."""
    monkeypatch.setattr(starvation, "time", clock := ManualTime())
    listener = Listener()

    def is_told() -> bool:
        clock.advance(0.01)
        return bool(told(caplog))

    def call_later() -> None:
        until(is_told)
        listener.hear(String())

    look()
    clock.advance(0.5)
    look()
    assert told(caplog) == []
    with in_thread(call_later):
        listener.wait()
    [text] = told(caplog)
    assert "/listener has not been spun for 0." in text
    assert ", and subscription hear cannot be called: the program is in test_starvation.py:" in text
    assert text.endswith("; call rclpy.spin_once(self, timeout_sec=0.1) in the loop there, in place of a sleep")


def test_a_node_beside_one_that_a_thread_spins(node: Node, caplog: Caplog) -> None:
    """The program is elsewhere, but another spin would not help: there is one already."""
    other = Node("other")
    other.create_timer(0.01, lambda: None)
    with spun(node):
        until(lambda: told(caplog))
    [text] = told(caplog)
    assert text.startswith("/other has not been spun for ")
    assert "; spin all nodes together: executor = SingleThreadedExecutor()" in text


def test_an_executor_without_nodes(node: Node, caplog: Caplog) -> None:
    """It is the one that has to get the node."""
    node.create_timer(0.01, lambda: None)
    executor = SingleThreadedExecutor()
    with in_thread(executor.spin):
        until(lambda: told(caplog))
        executor.shutdown()
    [text] = told(caplog)
    assert text.endswith("; its executor has no node: write executor.add_node(node) before it spins")


def test_a_node_beside_the_one_that_is_spun(node: Node, caplog: Caplog) -> None:
    """Told with where the others are spun, by a thread that does nothing else."""
    other = Node("other")
    other.create_timer(0.01, lambda: None)
    node.create_timer(0.01, lambda: rclpy.try_shutdown() if told(caplog) else None)
    rclpy.spin(node)
    [text] = told(caplog)
    assert text.startswith("/other has not been spun for ")
    assert "; spin all nodes together: executor = SingleThreadedExecutor(), executor.add_node(node) for" in text


def test_a_node_that_is_spun_now_and_then(node: Node, caplog: Caplog) -> None:
    """Nothing is told; nor where the program waits for something of ROS's."""
    node.create_timer(0.001, lambda: None)
    client = node.create_client(Trigger, "nothing")
    end = time.monotonic() + 0.5
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.01)
        client.wait_for_service(0.2)
    assert told(caplog) == []


@pytest.mark.parametrize("is_spun", [False, True])
def test_an_executor_that_nobody_spins(network: Any, caplog: Caplog, is_spun: bool) -> None:
    """Its nodes are told when they end, with the call that is missing; not if it has looked for work once."""
    rclpy.init()
    executor, nodes = MultiThreadedExecutor(2), [Node("first"), Node("second")]
    for node in nodes:
        node.create_timer(1.0, lambda: None)
        executor.add_node(node)
        if is_spun:
            executor.spin_once(0)
    executor.shutdown()
    rclpy.shutdown()
    found = [text for text in told(caplog) if "before /" in text]
    assert [text.endswith(": call executor.spin() before it") for text in found] == ([] if is_spun else [True, True])


def test_a_node_that_ends_without_having_been_spun(node: Node, caplog: Caplog) -> None:
    """Told with its callbacks, wherever they stand; not of one that has none, or was spun, or ends in an error."""

    def answer(request: Any, response: Any) -> Any:
        return response

    for name, ends in (("left", False), ("destroyed", True)):
        one = Node(name)
        one.create_service(Trigger, name, answer)
        if ends:
            one.destroy_node()
    try:
        raise KeyError
    except KeyError:
        failed = Node("failed")
        failed.create_service(Trigger, "failed", answer)
        failed.destroy_node()
    asking = Node("asking")
    asking.create_client(Trigger, "left")
    was_spun = Node("spun")
    was_spun.create_service(Trigger, "spun", answer)
    rclpy.spin_once(was_spun, timeout_sec=0)
    own = inspect.currentframe()
    assert own is not None
    rclpy.shutdown()
    ended, line = own.f_lineno - 1, answer.__code__.co_firstlineno
    assert [text.partition(" could")[0] for text in told(caplog)] == [
        f"{why}, so service answer (test_starvation.py:{line})"
        for why in (
            "/destroyed ends and was never spun",
            f"rclpy is shut down in test_starvation.py:{ended} before /left was spun",
        )
    ]
