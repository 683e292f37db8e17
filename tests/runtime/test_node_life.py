"""The hooks at both ends of a node's life."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Generator
from contextlib import asynccontextmanager, contextmanager
from typing import Any

import pytest

from graphflow import Client, Node, Publisher, service, subscription, task, timer
from graphflow.errors import ServiceUnavailable
from graphflow.msgs.std_msgs.msg import Int32
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.runtime import core
from graphflow.runtime.core import core_of
from graphflow.runtime.run import serve
from graphflow.testing import Graph


class Robot(Node):
    """Writes down what happens to it."""

    out = Publisher(Int32, "out")
    helper = Client(Empty, "help")

    def __init__(self, **options: Any) -> None:
        super().__init__("robot", **options)
        self.story: list[str] = []
        self.go_on = asyncio.Event()

    async def on_start(self) -> None:
        self.story.append("preparing")
        await self.go_on.wait()
        self.story.append("prepared")

    async def on_shutdown(self) -> None:
        self.out.publish(Int32(data=-1))
        self.story.append("goodbye")

    @subscription(Int32, "in")
    def heard(self, message: Int32) -> None:
        self.story.append(f"heard {message.data}")

    @service(Empty, "serve")
    def serve(self, request: Empty.Request) -> Empty.Response:
        self.story.append("served")
        return Empty.Response()

    @timer(1.0)
    def tick(self) -> None:
        self.story.append("tick")

    @task
    async def work(self) -> None:
        self.story.append("working")
        await self.clock.sleep(1e6)


async def test_no_handler_runs_before_on_start_has_returned(graph: Graph) -> None:
    """Neither subscription, service, timer nor task; services of the node itself answer already."""
    robot = Robot()
    publisher = graph.publisher(Int32, "/in")
    starting = asyncio.ensure_future(graph.start(robot))
    await graph.settle()
    publisher.publish(Int32(data=1))
    await graph.clock.advance(3.0)
    assert robot.story == ["preparing"]
    services = robot.context.cache.services()
    assert "/robot/get_parameters" in services
    assert "/serve" not in services

    robot.go_on.set()
    await starting
    publisher.publish(Int32(data=2))
    await graph.clock.advance(1.0)
    assert robot.story == ["preparing", "prepared", "working", "heard 2", "tick"]


class AsksItself(Node):
    home = Client(Empty, "~/home")

    async def on_start(self) -> None:
        await self.home.call(Empty.Request())

    @service(Empty, "~/home")
    async def go_home(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


async def test_a_service_of_its_own_is_not_there_in_on_start(graph: Graph) -> None:
    """It is said why nobody answers."""
    starting = asyncio.ensure_future(graph.start(AsksItself("lonely")))
    await graph.clock.advance(2.0)

    with pytest.raises(ServiceUnavailable, match="is this node's own, and opens when on_start has returned"):
        await starting


async def test_an_on_start_that_takes_long_is_told(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """With the line in which it waits."""
    robot = Robot()
    starting = asyncio.ensure_future(graph.start(robot))
    await graph.clock.advance(4.0)
    assert "has not returned" not in caplog.text
    await graph.clock.advance(2.0)
    robot.go_on.set()
    await starting
    await graph.start(Node("quick"))
    await graph.clock.advance(20.0)

    assert caplog.text.count("on_start has not returned for 5 s (test_node_life.py:") == 1


async def test_publishers_and_clients_work_in_on_start(graph: Graph) -> None:
    """And what is created there is opened when its time comes."""
    heard = graph.tap(Int32, "/out")
    log: list[str] = []

    class Eager(Node):
        out = Publisher(Int32, "out")
        helper = Client(Empty, "help")

        async def on_start(self) -> None:
            await self.out.wait_matched()
            self.out.publish(Int32(data=5))
            await self.helper.call(Empty.Request())
            self.create_timer(1.0, lambda: log.append("tick"))
            await self.clock.sleep(3.0)

    server = Node("server")
    server.create_service(Empty, "help", lambda request: Empty.Response())
    await graph.start(server)
    starting = asyncio.ensure_future(graph.start(Eager()))
    await graph.clock.advance(2.9)
    assert [m.data for m in heard] == [5]
    assert log == []
    await graph.clock.advance(0.1)
    await starting
    await graph.clock.advance(1.0)
    assert log == ["tick"]


async def test_an_error_in_on_start_ends_the_node(graph: Graph) -> None:
    """It comes out of `start`, nothing stays open, and there is no goodbye of what never began."""

    class Broken(Robot):
        async def on_start(self) -> None:
            raise OSError("no camera")

    robot = Broken()
    with pytest.raises(OSError, match="no camera"):
        await graph.start(robot)
    assert not robot.is_running
    assert robot.story == []
    assert not graph.network.tokens


async def test_on_shutdown_can_still_publish(graph: Graph) -> None:
    """Handlers and tasks have ended by then; its last words are heard."""
    heard = graph.tap(Int32, "/out")
    robot = Robot()
    robot.go_on.set()
    await graph.start(robot)
    await graph.stop(robot)
    assert robot.story == ["preparing", "prepared", "working", "goodbye"]
    assert [m.data for m in heard] == [-1]


async def test_what_was_entered_is_left_in_reverse(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Asynchronous and plain context managers alike, after on_shutdown, even if that fails."""
    story: list[str] = []

    @contextmanager
    def plain() -> Generator[str, None, None]:
        yield "plain"
        story.append("plain left")

    @asynccontextmanager
    async def later() -> AsyncGenerator[str, None]:
        yield "later"
        story.append("later left")

    class Holder(Node):
        async def on_start(self) -> None:
            story.append(await self.enter(plain()))
            story.append(await self.enter(later()))

        async def on_shutdown(self) -> None:
            story.append("goodbye")
            raise RuntimeError("cannot say more")

    holder = Holder()
    await graph.start(holder)
    await graph.stop(holder)
    assert story == ["plain", "later", "goodbye", "later left", "plain left"]
    assert "on_shutdown: RuntimeError: cannot say more" in caplog.text


async def test_a_goodbye_has_a_limit(
    graph: Graph, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One that takes too long is cancelled and said so; the node is gone all the same."""
    monkeypatch.setattr(core, "STOP_LIMIT", 0.01)

    class Slow(Node):
        async def on_shutdown(self) -> None:
            await asyncio.sleep(60.0)

    slow = Slow()
    await graph.start(slow)
    await core_of(slow).stop()
    assert "on_shutdown has taken more than 0 s and was cancelled" in caplog.text
    assert not slow.is_running


async def test_a_node_that_prepares_can_be_stopped(graph: Graph) -> None:
    """A request to stop does not wait for on_start."""
    robot, stop = Robot(), asyncio.Event()
    anchor = Node("anchor")
    await graph.start(anchor)
    serving = asyncio.ensure_future(serve([robot], anchor.context, stop))
    await graph.settle()
    assert robot.story == ["preparing"]
    stop.set()
    await asyncio.wait_for(serving, 5.0)
    assert not robot.is_running
    assert robot.story == ["preparing"]
