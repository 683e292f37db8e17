"""Waits for servers that nobody offers, and calls that no server answers."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import pytest
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from std_srvs.srv import Trigger

import rclpy
from graphflow.deadlock.search import Search
from graphflow.runtime.mistakes.network.unserved import GAP
from rclpy.action import ActionClient, ActionServer
from rclpy.impl.deadlock import waiting
from rclpy.impl.watches import unserved
from rclpy.impl.watches.unserved import Unserved
from rclpy.node import Node
from rclpy.parameter_client import AsyncParameterClient
from tests.cases import slow
from tests.rclpy.looking import ManualTime, look
from tests.until import until

Caplog = pytest.LogCaptureFixture
LIMIT = 10.0


@pytest.fixture(autouse=True)
def _soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unserved, "WARN_AFTER", 0.1)
    monkeypatch.setattr(waiting, "LOOK_EVERY", 0.02)


def told(caplog: Caplog) -> list[str]:
    return [r.getMessage() for r in caplog.records if r.name == "graphflow" and r.levelname == "WARNING"]


@contextmanager
def waiting_for(wait: Callable[[float], bool]) -> Iterator[None]:
    """A thread that waits again and again, as programs do."""
    is_over = threading.Event()

    def loop() -> None:
        while not (wait(0.03) or is_over.is_set()):
            pass  # programs log a line here

    thread = threading.Thread(target=loop, name="own")
    thread.start()
    try:
        yield
    finally:
        is_over.set()
        thread.join(LIMIT)
        assert not thread.is_alive()


def serve(node: Node) -> None:
    """Offer two services and an action."""
    node.create_service(Trigger, "switch", lambda request, response: response)
    node.create_service(AddTwoInts, "add", lambda request, response: response)
    ActionServer(node, Fibonacci, "count", lambda goal: Fibonacci.Result())


WAITS: list[tuple[str, Callable[[Node], Callable[[float], bool]], str]] = [
    (
        "a misspelt service",
        lambda node: node.create_client(Trigger, "swich").wait_for_service,
        "no node offers the service /swich [std_srvs/srv/Trigger]; did you mean '/switch'?",
    ),
    (
        "a service of another type",
        lambda node: node.create_client(Trigger, "add").wait_for_service,
        "service /add is of type example_interfaces/srv/AddTwoInts, not std_srvs/srv/Trigger",
    ),
    (
        "a misspelt action",
        lambda node: ActionClient(node, Fibonacci, "cuont").wait_for_server,
        "no node offers the action /cuont [example_interfaces/action/Fibonacci]; did you mean '/count'?",
    ),
    (
        "the parameters of a misspelt node",
        lambda node: AsyncParameterClient(node, "nod").wait_for_services,
        "no node offers the service /nod/get_parameters [rcl_interfaces/srv/GetParameters]; "
        "did you mean '/node/get_parameters'?",
    ),
]


@pytest.mark.parametrize(("make", "text"), [row[1:] for row in WAITS], ids=[row[0] for row in WAITS])
def test_a_wait_for_what_nobody_offers(
    node: Node, caplog: Caplog, make: Callable[[Node], Callable[[float], bool]], text: str
) -> None:
    """Is told once with its line, however often the program waits again."""
    serve(node)
    with waiting_for(make(node)):
        until(lambda: told(caplog))
        look(times=5)
    [only] = told(caplog)
    line = waiting_for.__wrapped__.__code__.co_firstlineno + 6  # type: ignore[attr-defined]
    assert only.startswith("/node has waited for 0.")
    assert only.endswith(f" s in test_unserved.py:{line} in loop: {text}")


def test_a_server_that_comes(node: Node, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is told of it."""
    monkeypatch.setattr(unserved, "time", clock := ManualTime())
    client = node.create_client(Trigger, "switch")
    with waiting_for(client.wait_for_service):
        until(lambda: client in watch()._since)
        serve(node)
    clock.advance(0.2)
    look()
    assert told(caplog) == []


CALLS: list[tuple[str, Callable[[Node], Callable[[], Any]], str]] = [
    (
        "a misspelt service",
        lambda node: partial(node.create_client(Trigger, "swich").call_async, Trigger.Request()),
        "(wait_for_service() waits for one): "
        "no node offers the service /swich [std_srvs/srv/Trigger]; did you mean '/switch'?",
    ),
    (
        "a misspelt action",
        lambda node: partial(ActionClient(node, Fibonacci, "cuont").send_goal_async, Fibonacci.Goal()),
        "(wait_for_server() waits for one): "
        "no node offers the action /cuont [example_interfaces/action/Fibonacci]; did you mean '/count'?",
    ),
]


@pytest.mark.parametrize(("make", "text"), [row[1:] for row in CALLS], ids=[row[0] for row in CALLS])
def test_a_call_that_nobody_answers(
    node: Node, caplog: Caplog, make: Callable[[Node], Callable[[], Any]], text: str
) -> None:
    """Is told once, however often the program calls, and also where nobody spins."""
    serve(node)
    call = make(node)
    call()
    until(lambda: told(caplog))
    call()
    look()
    lost = "a call of /node will never be answered, since it has no server"
    assert told(caplog) == [f"{lost} {text}"]


def test_a_call_whose_server_comes_and_goes(node: Node, caplog: Caplog) -> None:
    """An answered one is none that is lost; one that comes too early, or whose server leaves, is."""
    client = node.create_client(Trigger, "switch")
    server = node.create_service(Trigger, "switch", lambda request, response: response)
    assert client.wait_for_service(LIMIT)
    future = client.call_async(Trigger.Request())
    rclpy.spin_until_future_complete(node, future, timeout_sec=LIMIT)
    assert future.done()
    assert client.endpoint.lost == 0
    node.destroy_service(server)
    client.call_async(Trigger.Request())
    until(lambda: told(caplog))
    assert told(caplog)[0].endswith(
        ": the server of /switch went away before it answered, or came after it; its terminal may say why"
    )


def watch() -> Unserved:
    """What looks at the clients of the default context."""
    life = rclpy.get_default_context().life
    assert life is not None
    found: Unserved = next(w for w in life.network().elsewhere[0].watches.each if isinstance(w, Unserved))  # type: ignore[attr-defined]
    return found


def test_a_wait_of_which_the_search_tells(node: Node, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """Is in a deadlock, whose report says more."""
    asked = []

    def has_reported(self: Search, activity: str, title: str) -> bool:
        asked.append(title)
        return True

    monkeypatch.setattr(Search, "has_reported", has_reported)
    with waiting_for(node.create_client(Trigger, "switch").wait_for_service):
        until(lambda: "thread own" in asked)
    assert told(caplog) == []


@slow
def test_a_program_that_asks_now_and_then(node: Node, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """Does without the server: the time between its waits does not count."""
    monkeypatch.setattr(unserved, "time", clock := ManualTime())
    client = node.create_client(Trigger, "swich")
    for _ in range(5):
        with waiting_for(client.wait_for_service):
            until(lambda: watch()._last.get(client) == clock.now)
        clock.advance(2 * GAP)
    look()
    assert told(caplog) == []
