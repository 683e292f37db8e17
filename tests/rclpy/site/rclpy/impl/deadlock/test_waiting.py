"""Programs that are stuck, and programs that merely wait, in threads of their own on a network in memory."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from std_msgs.msg import String
from std_srvs.srv import Trigger

import rclpy
from graphflow.analysis.class_source import source_of
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.impl.deadlock import conditions, stacks, waiting
from rclpy.node import Node
from tests.cases import sample, slow
from tests.flat import flat
from tests.rclpy import planted, waiting_programs
from tests.until import until

LIMIT = 20.0


def reports(caplog: pytest.LogCaptureFixture) -> list[str]:
    """What was said of deadlocks."""
    return [r.getMessage() for r in caplog.records if "DEADLOCK" in r.getMessage() or "IN VAIN" in r.getMessage()]


@pytest.fixture(autouse=True)
def _files(monkeypatch: pytest.MonkeyPatch) -> None:
    """The program is what these files hold: not the tests, which end futures as well."""
    files = [str(module.__file__) for module in (planted, waiting_programs)]
    monkeypatch.setattr(conditions, "programs_files", lambda: files)


class Program:
    """A program of one node that spins in a thread."""

    def __init__(self, cls: type[Any]) -> None:
        if not rclpy.ok():
            rclpy.init()
        self.node = cls()
        self.executor: Executor = SingleThreadedExecutor()
        if cls.threads > 1:
            self.executor = MultiThreadedExecutor(cls.threads)
        self.thread = threading.Thread(target=self._spin)
        self.executor.add_node(self.node)
        self.thread.start()

    def _spin(self) -> None:
        try:
            self.executor.spin()
        except Exception as error:  # as the context ends; a test that needs to know looks at what the node has done
            logging.getLogger("tests").debug("%r", error)

    def end(self) -> None:
        """Let go of whatever blocks."""
        rclpy.try_shutdown()
        for value in vars(self.node).values():
            if isinstance(value, threading.Event):
                value.set()
        if hasattr(self.node, "items"):
            self.node.items.put(None)
        if hasattr(self.node, "flag"):
            self.node.flag = True
        if isinstance(getattr(self.node, "rate", None), planted.HandMadeRate):
            self.node.rate.fired = True
        if hasattr(self.node, "newest"):
            self.node.newest = String(data="end")
        if hasattr(self.node, "navigator"):
            self.node.navigator.result = "no more"
        if hasattr(self.node, "store") and self.node.store.lock.locked():
            self.node.store.lock.release()
        self.thread.join(LIMIT)
        assert not self.thread.is_alive()


@pytest.fixture
def start() -> Iterator[Callable[[type[Any]], Program]]:
    """Start programs."""
    programs: list[Program] = []

    def begin(cls: type[Any]) -> Program:
        programs.append(Program(cls))
        return programs[-1]

    yield begin
    for program in programs:
        program.end()


def line_of(cls: type[Any]) -> int:
    """The line that is marked."""
    lines = Path(planted.__file__).read_text("utf-8").splitlines()
    return next(n for n, line in enumerate(lines, 1) if line.endswith(f"# stuck: {cls.__name__}"))


@pytest.mark.parametrize(
    ("cls", "words"),
    [pytest.param(cls, words, id=f"{cls.__name__}-{n}") for n, (cls, _, words) in enumerate(planted.PLANTED)],
)
def test_what_is_stuck_is_told(
    start: Callable[[type[Any]], Program], caplog: pytest.LogCaptureFixture, cls: type[Any], words: str
) -> None:
    """With the line, and what to do about it."""
    start(cls)
    until(lambda: reports(caplog), cls.__name__)
    told = flat(reports(caplog)[0])
    assert f"planted.py:{line_of(cls)} in " in told
    assert words in told


@slow
@pytest.mark.parametrize("cls", dict.fromkeys(fixed for _, fixed, _ in planted.PLANTED), ids=lambda c: c.__name__)
def test_what_the_report_asks_for_ends_it(
    start: Callable[[type[Any]], Program], caplog: pytest.LogCaptureFixture, cls: type[Any]
) -> None:
    """The same program with the change comes to its end."""
    program = start(cls)
    assert program.node.done.wait(LIMIT)
    assert not reports(caplog)


RIGHT = [(way, a) for way in waiting_programs.WAYS for a in waiting_programs.ARRANGEMENTS]
RIGHT += [(way, a) for way in waiting_programs.AWAITS for a in waiting_programs.ARRANGEMENTS[:3]]


@slow
@pytest.mark.parametrize(("way", "arrangement"), sample(RIGHT, 9), ids=str)
def test_who_merely_waits_is_not_called_stuck(
    caplog: pytest.LogCaptureFixture, network: object, way: str, arrangement: str
) -> None:
    """However it is done, while something else goes on that ends it."""
    running = waiting_programs.Running(way, arrangement)
    try:
        assert running.node.done.wait(LIMIT)
    finally:
        running.end()
    assert not [r.getMessage() for r in caplog.records if r.name == "graphflow" and r.levelno >= logging.WARNING]


def test_what_those_wait_for_can_be_followed() -> None:
    """Else nothing would ever be found there, and the test above could not fail."""
    for cls in (waiting_programs.Waiter, waiting_programs.Awaiter, waiting_programs.CoroutineTimer):
        source = source_of(object.__new__(cls))
        assert all(source.uses(name) for name in ("arrived", "lock", "condition", "items", "flag", "future", "promise"))


class TwoServers(planted.Asker):
    """Its own server is kept out, and another answers in time."""

    threads = 2
    client_group = MutuallyExclusiveCallbackGroup

    def tick(self) -> None:
        self.client.call(Trigger.Request())
        self.done.set()


@slow
def test_a_rate_of_another_node(
    start: Callable[[type[Any]], Program], caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its timer fires while the node itself waits."""
    rclpy.init()
    other, executor = Node("other"), SingleThreadedExecutor()
    executor.add_node(other)
    thread = threading.Thread(target=spin, args=(executor,))

    monkeypatch.setattr(planted.SleepsElsewhere, "elsewhere", other)
    thread.start()
    program = start(planted.SleepsElsewhere)
    assert program.node.done.wait(LIMIT)
    assert not reports(caplog)
    rclpy.try_shutdown()
    thread.join(LIMIT)


@slow
def test_of_two_servers_another_may_answer(
    start: Callable[[type[Any]], Program], caplog: pytest.LogCaptureFixture
) -> None:
    """So a call that one of them cannot take is no deadlock."""
    rclpy.init()
    other, executor = Node("other"), SingleThreadedExecutor()

    def slowly(request: Any, response: Any) -> Any:
        time.sleep(1.0)
        return response

    other.create_service(Trigger, "answer", slowly)
    executor.add_node(other)
    thread = threading.Thread(target=spin, args=(executor,))
    thread.start()
    program = start(TwoServers)
    assert program.node.done.wait(LIMIT)
    assert not reports(caplog)
    rclpy.try_shutdown()
    thread.join(LIMIT)


@slow
def test_both_servers_are_kept_out(start: Callable[[type[Any]], Program], caplog: pytest.LogCaptureFixture) -> None:
    """Then no answer can come."""

    class Twice(TwoServers):
        def __init__(self) -> None:
            super().__init__()
            self.create_service(Trigger, "answer", self.answer)

    start(Twice)
    until(lambda: reports(caplog), "the report")
    assert "which timer fire of /asker holds" in flat(reports(caplog)[0])


def test_a_server_that_nobody_spins(caplog: pytest.LogCaptureFixture, network: object) -> None:
    """While a thread spins its client alone: that its own answers are taken does not help."""
    rclpy.init()
    server, client_node = Node("server"), Node("client")
    server.create_service(Trigger, "answer", lambda request, response: response)
    client = client_node.create_client(Trigger, "answer")
    assert client.wait_for_service(LIMIT)
    future = client.call_async(Trigger.Request())

    def help_out() -> None:
        until(lambda: reports(caplog), "the report")
        rclpy.spin_once(server, executor=SingleThreadedExecutor(), timeout_sec=LIMIT)

    helper = threading.Thread(target=help_out, name="graphflow-helper")  # which is not taken for the program's
    helper.start()
    rclpy.spin_until_future_complete(client_node, future, timeout_sec=LIMIT)
    helper.join(LIMIT)
    told = flat(reports(caplog)[0])
    assert "thread MainThread of /client" in told
    assert "waits for a thread that spins /server, and there is none" in told
    assert "executor.add_node(...) for both nodes, executor.spin_until_future_complete(future)" in told
    assert future.done()
    rclpy.shutdown()


@slow
def test_a_lock_of_a_thread_that_asks(caplog: pytest.LogCaptureFixture, network: object) -> None:
    """And which the service wants that answers."""
    rclpy.init()
    node = planted.AsksInsideALock()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    spinning = threading.Thread(target=spin, args=(executor,))
    asking = threading.Thread(target=node.ask, name="asking")
    spinning.start()
    asking.start()
    until(lambda: reports(caplog), "the report")
    told = flat(reports(caplog)[0])
    assert f"planted.py:{line_of(planted.AsksInsideALock)} in ask" in told
    assert "which thread asking of /asker holds" in told
    assert "to where it does not hold self.lock" in told
    rclpy.shutdown()
    for thread in (asking, spinning):
        thread.join(LIMIT)


def spin(executor: Executor) -> None:
    """Spin until the context ends."""
    with suppress(Exception):
        executor.spin()


@slow
def test_what_stands_still_is_looked_into_again(start: Callable[[type[Any]], Program]) -> None:
    """The same line may wait for something else by then."""
    program = start(planted.Sleeper)
    life = program.node.context.life
    alerts: list[int] = []
    life.network().ledger.alert = lambda: alerts.append(1)
    until(lambda: len(alerts) >= 4, "looks")
    program.node.arrived.set()
    assert program.node.done.wait(LIMIT)


@slow
def test_a_look_that_fails_is_not_the_last(
    start: Callable[[type[Any]], Program], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Something may change its size while it is looked at."""
    fails, real = [1, 1], stacks.standing

    def standing() -> dict[int, tuple[int, int]]:
        if fails:
            fails.pop()
            raise RuntimeError("dictionary changed size during iteration")
        return real()

    program = start(planted.Sleeper)
    alerts: list[int] = []
    program.node.context.life.network().ledger.alert = lambda: alerts.append(1)
    monkeypatch.setattr(waiting, "standing", standing)
    until(lambda: not fails, "it has failed twice")
    count = len(alerts)
    until(lambda: len(alerts) > count, "it looks again")
    program.node.arrived.set()
