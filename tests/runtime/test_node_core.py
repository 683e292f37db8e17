"""A node's life: its start, its tasks, and its end."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncGenerator, Generator
from contextlib import asynccontextmanager, contextmanager
from typing import Any

import pytest

from graphflow import (
    Client,
    DeclarationError,
    GraphflowError,
    Node,
    Param,
    ParameterError,
    Publisher,
    ServiceUnavailable,
    action,
    service,
    subscription,
    task,
    timer,
)
from graphflow.errors import ClosedError
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.runtime import node_work
from graphflow.runtime.context import Context
from graphflow.runtime.ending import StopRequest
from graphflow.runtime.node_core import core_of
from graphflow.runtime.run import serve
from graphflow.testing import Graph
from graphflow.transport.memory import MemorySession
from tests.cases import slow
from tests.runtime.cast import Talker


class Robot(Node):
    """Record its callbacks."""

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
    """The error explains that it opens after `on_start`."""
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

    assert caplog.text.count("on_start has not returned for 5 s (test_node_core.py:") == 1


async def test_publishers_and_clients_work_in_on_start(graph: Graph) -> None:
    """Endpoints created there open at the right time."""
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
    """`start` raises it, nothing stays open, and `on_shutdown` does not run."""

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


async def test_a_node_that_prepares_can_be_stopped(graph: Graph) -> None:
    """A request to stop does not wait for on_start."""
    robot, stop = Robot(), StopRequest()
    anchor = Node("anchor")
    await graph.start(anchor)
    serving = asyncio.ensure_future(serve([robot], anchor.context, stop))
    await graph.settle()
    assert robot.story == ["preparing"]
    stop.set()
    await asyncio.wait_for(serving, 5.0)
    assert not robot.is_running
    assert robot.story == ["preparing"]


async def test_nodes_and_endpoints_have_ids_of_their_own(graph: Graph) -> None:
    """No two of a process share one, as GIDs are made from them."""
    one, two = Talker("one"), Talker("two")
    context = Context(graph.network.session(asyncio.get_running_loop()), clock=graph.clock)
    await core_of(one).start(context)
    await core_of(two).start(context)
    await graph.settle()
    ids = [e.eid for e in context.cache]
    await core_of(one).stop()
    await core_of(two).stop()
    await context.close()

    assert len(ids) == len(set(ids)) > 10


async def test_an_unknown_parameter_is_refused_at_the_start(graph: Graph) -> None:
    """A node may declare parameters until then; remaining overrides are an error, and nothing stays open."""
    node = Talker(rat=2.0)
    with pytest.raises(GraphflowError) as caught:
        await graph.start(node)

    assert str(caught.value) == ("node /talker: there is no parameter 'rat' (from argument); did you mean 'rate'?")
    assert graph.network.tokens == {}
    late = Talker(late=5)
    assert late.declare_parameter("late", 1, ge=0, le=9) == 5
    await graph.start(late)
    with pytest.raises(ParameterError, match="declared twice"):
        late.declare_parameter("late", 1)


async def test_a_node_is_started_once(graph: Graph) -> None:
    """Neither while it runs nor after it was stopped."""
    node = Talker()
    await graph.start(node)
    with pytest.raises(ClosedError, match="node /talker is already running"):
        await graph.start(node)
    await graph.stop(node)
    with pytest.raises(ClosedError, match="node /talker has been stopped; create a new one"):
        await graph.start(node)


async def test_what_is_not_running_has_no_context(graph: Graph) -> None:
    """Its property raises ClosedError."""
    with pytest.raises(ClosedError, match="node /talker is not running"):
        Talker().clock  # noqa: B018


@slow
async def test_a_start_that_fails_leaves_nothing_open(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """It raises the error, and announcements are withdrawn."""

    def refuse(*_: object) -> None:
        raise GraphflowError("no callers here")

    monkeypatch.setattr(MemorySession, "open_caller", refuse)
    node = Talker()
    with pytest.raises(GraphflowError, match="no callers here"):
        await graph.start(node)

    assert graph.network.tokens == {}
    assert not any(graph.network.senders.values())
    assert not node.is_running


async def test_an_unused_remap_is_said(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A rule that matches nothing is probably misspelt; the nearest name is suggested."""
    await graph.start(Talker(remap=["chater:=news", "chatter:=talk", "other:x:=y"]))

    [record] = caplog.records
    assert record.levelno == logging.WARNING
    assert record.getMessage() == ("the remap chater:=news matches no name of this node; did you mean 'chatter'?")


@pytest.mark.parametrize(
    ("rule", "hint"),
    [
        ("rate:=2.0", "-p rate:=2.0"),
        ("use_sim_time:=true", "-p use_sim_time:=true"),
        ("_rate:=fast", "-p rate:=fast"),
        ("rate:=speed", ""),
    ],
)
async def test_a_remap_that_sets_a_parameter(
    graph: Graph, caplog: pytest.LogCaptureFixture, rule: str, hint: str
) -> None:
    """A value is not a name, so it is reported even if the class makes names at run time."""
    is_private = rule.startswith("_")
    made: Any = type("Maker", (Node,), {"rate": Param(1.0), "dynamic_names": () if is_private else True})
    await graph.start(made(remap=[rule]))
    way = f"the remap {rule} matches no name of this node; to set the parameter write {hint}"
    assert [record.getMessage() for record in caplog.records] == ([way] if hint else [])


@pytest.mark.parametrize(("names", "warned"), [(True, False), (("*/pose",), False), (("*/other",), True)])
async def test_a_remap_of_a_name_made_later(
    graph: Graph, caplog: pytest.LogCaptureFixture, names: Any, warned: bool
) -> None:
    """With `dynamic_names`, a rule for such a name is not reported as unused."""
    made: Any = type("Maker", (Node,), {"dynamic_names": names})

    await graph.start(made(remap=["turtle1/pose:=here"]))

    assert bool(caplog.records) is warned


async def test_a_task_runs_once_the_node_is_up(graph: Graph) -> None:
    """Beside everything else; its end is not the node's."""
    log: list[str] = []

    class Worker(Node):
        out = Publisher(String, "out")

        @task
        async def work(self) -> None:
            self.out.publish(String(data="from the task"))
            log.append("begun")
            await self.clock.sleep(1.0)
            log.append("ended")

        @timer(0.75)
        async def tick(self) -> None:
            log.append("tick")

    node = Worker()
    await graph.start(node)
    await graph.clock.advance(2.0)

    assert log == ["begun", "tick", "ended", "tick"]
    assert node.out.published == 1
    assert node.is_running


@pytest.mark.parametrize("spawned", [False, True])
async def test_a_failing_task_ends_the_node(graph: Graph, caplog: pytest.LogCaptureFixture, spawned: bool) -> None:
    """Its error is logged with the traceback, and `wait_ended` raises it."""

    class Worker(Node):
        @task
        async def work(self) -> None:
            if spawned:
                self.spawn(self.fail, "spawned")
            else:
                await self.fail("declared")

        async def fail(self, how: str) -> None:
            await asyncio.sleep(0)
            raise ValueError(how)

    node = Worker()
    await graph.start(node)

    with pytest.raises(ValueError, match="spawned" if spawned else "declared"):
        await node.wait_ended()
    [record] = caplog.records
    name = "fail" if spawned else "work"
    assert record.getMessage().startswith(f"task /worker.{name}: ValueError: ")
    assert record.exc_info is not None
    assert isinstance(core_of(node).failure, ValueError)


async def test_an_error_of_graphflows_own_is_a_sentence(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """It has the next step; a traceback would only hide it."""

    class Caller(Node):
        adder = Client(AddTwoInts, "add")

        @task
        async def work(self) -> None:
            await self.adder.call(AddTwoInts.Request())

    node = Caller()
    await graph.start(node)
    await graph.clock.advance(1.0)
    with pytest.raises(ServiceUnavailable):
        await node.wait_ended()

    [record] = caplog.records
    assert record.getMessage().startswith("task /caller.work: no node offers the service /add")
    assert record.exc_info is None


async def test_the_first_failure_counts(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A second task's error has no effect, and asyncio does not complain."""

    class Worker(Node):
        @task
        async def one(self) -> None:
            raise ValueError("first")

        @task
        async def two(self) -> None:
            await asyncio.sleep(0)
            raise ValueError("second")

    node = Worker()
    await graph.start(node)

    with pytest.raises(ValueError, match="first"):
        await node.wait_ended()
    assert str(core_of(node).failure) == "first"


async def test_shutdown_ends_the_node_from_within(graph: Graph) -> None:
    """`wait_ended` returns; a second call is harmless."""

    class Quitter(Node):
        @timer(1.0)
        async def quit(self) -> None:
            self.shutdown()
            self.shutdown()

    node = Quitter()
    node.shutdown()  # before the start there is nothing to end
    await graph.start(node)
    waiting = asyncio.create_task(node.wait_ended())
    await graph.clock.advance(0.9)
    assert not waiting.done()
    await graph.clock.advance(0.1)

    await waiting
    assert node.is_running


async def test_waiting_for_the_end_can_be_cancelled(graph: Graph) -> None:
    """The node does not notice."""
    node = Talker()
    await graph.start(node)
    waiting = asyncio.create_task(node.wait_ended())
    await graph.settle()
    waiting.cancel()
    await graph.settle()

    assert waiting.cancelled()
    again = asyncio.create_task(node.wait_ended())
    await graph.settle()
    assert not again.done()
    node.shutdown()
    await again


class Tidy(Node):
    """Takes its time with the cleanup of a task, a subscription and a timer."""

    def __init__(self) -> None:
        super().__init__()
        self.out = self.create_publisher(String, "out")
        self.ended: list[str] = []
        self.gate = asyncio.Event()

    async def hold(self, name: str) -> None:
        try:
            await asyncio.Event().wait()
        finally:
            await self.gate.wait()
            self.out.publish(String(data=f"{name} cleaned up"))  # the network is still there
            self.ended.append(name)

    @task
    async def work(self) -> None:
        await self.hold("task")

    @subscription(String, "in")
    async def heard(self, message: String) -> None:
        await self.hold("subscription")

    @timer(1.0)
    async def tick(self) -> None:
        await self.hold("timer")


async def test_stop_waits_for_the_cleanup(graph: Graph) -> None:
    """Handlers and tasks are cancelled, and the network is there until their `finally` blocks have ended."""
    node = Tidy()
    await graph.start(node)
    heard = graph.tap(String, "/out")
    graph.publisher(String, "/in").publish(String())
    await graph.clock.advance(1.0)
    stopping = asyncio.create_task(core_of(node).stop())
    await graph.settle()
    assert not stopping.done()
    assert node.is_running

    node.gate.set()
    await stopping
    await graph.settle()

    assert sorted(node.ended) == ["subscription", "task", "timer"]
    assert len(heard) == 3
    assert not any("/tidy/" in token for token in graph.network.tokens)


async def test_nothing_begins_after_the_stop(graph: Graph) -> None:
    """Messages that still arrive and timers that fall due are not handled."""
    node = Tidy()
    await graph.start(node)
    stopping = asyncio.create_task(core_of(node).stop())
    await graph.settle()
    publisher = graph.publisher(String, "/in")
    publisher.publish(String())
    await graph.clock.advance(5.0)
    node.gate.set()
    await stopping

    assert node.ended == ["task"]


async def test_two_may_stop_a_node(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Both return when it has stopped; stopping a stopped node returns at once."""
    node = Tidy()
    await graph.start(node)
    graph.publisher(String, "/in").publish(String())
    await graph.settle()
    node.gate.set()
    await asyncio.gather(core_of(node).stop(), core_of(node).stop())
    await core_of(node).stop()

    assert sorted(node.ended) == ["subscription", "task"]
    assert caplog.records == []


async def test_a_node_that_was_never_started_can_be_stopped(graph: Graph) -> None:
    """`stop` does nothing."""
    await core_of(Talker()).stop()


@pytest.mark.parametrize("what", ["task", "subscription"])
async def test_what_does_not_end_is_named(
    graph: Graph, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    """A cleanup that takes too long does not block the stop, and the log names its task."""
    monkeypatch.setattr(node_work, "STOP_LIMIT", 0.001)
    node = Tidy()
    await graph.start(node)
    if what == "subscription":
        graph.publisher(String, "/in").publish(String())
        await graph.settle()
    await graph.stop(node)

    assert not node.is_running
    [record] = caplog.records
    assert record.getMessage().startswith("still running 0 s after it was cancelled: /tidy.")
    assert ("/tidy.heard" in record.getMessage()) is (what == "subscription")
    assert "/tidy.work" in record.getMessage()
    node.gate.set()
    with pytest.raises(ClosedError):
        await let_go(graph, node)


async def let_go(graph: Graph, node: Tidy) -> None:
    """Release the stuck cleanup after its node has stopped."""
    await graph.settle()
    node.out.publish(String())


async def test_a_task_that_fails_while_it_stops(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The error is logged, and the stop goes on."""

    class Clumsy(Node):
        @task
        async def work(self) -> None:
            try:
                await asyncio.Event().wait()
            finally:
                raise ValueError("broke it while tidying up")

    node = Clumsy()
    await graph.start(node)
    await graph.stop(node)

    assert [r.getMessage() for r in caplog.records] == ["task /clumsy.work: ValueError: broke it while tidying up"]
    with pytest.raises(ValueError, match="tidying up"):
        await node.wait_ended()


async def test_a_stopped_node_has_ended(graph: Graph) -> None:
    """`wait_ended` is cancelled with it."""
    node = Talker()
    await graph.start(node)
    waiting: asyncio.Task[None] = asyncio.create_task(node.wait_ended())
    await graph.stop(node)

    assert waiting.cancelled()


async def test_a_cancelled_stop_leaves_nothing_open(graph: Graph) -> None:
    """Who is cancelled while it waits for cleanups withdraws the node all the same."""
    node = Tidy()
    await graph.start(node)
    stopping = asyncio.create_task(core_of(node).stop())
    await graph.settle()
    stopping.cancel()
    await graph.settle()
    assert stopping.cancelled()
    assert not node.is_running
    assert not any("tidy" in token for token in graph.network.tokens)


def test_spawn_needs_a_running_node() -> None:
    """It takes the function and not the coroutine, so that a refusal leaves no coroutine behind."""

    async def work() -> None: ...

    with pytest.raises(ClosedError):
        Talker().spawn(work)


NAMES = ("stop", "start", "tasks", "group", "runner", "id")
"""What a node's workings use themselves, and users may want to call their handlers."""


def named(name: str, kind: str) -> Any:
    """A handler of that name; the service, topic or action is called by the name too."""

    async def of_self(self: Any) -> None:
        self.said.append(name)

    async def of_two(self: Any, given: Any) -> Any:
        self.said.append(name)
        return {"service": Empty.Response, "action": Fibonacci.Result}.get(kind, lambda: None)()

    function = of_self if kind == "timer" else of_two
    function.__name__ = name
    declare: dict[str, Any] = {
        "timer": timer(1.0),
        "service": service(Empty, name),
        "subscription": subscription(Int32, name),
        "action": action(Fibonacci, name),
    }
    return declare[kind](function)


@pytest.mark.parametrize("kind", ["timer", "service", "subscription", "action"])
async def test_handlers_may_be_called_as_they_like(graph: Graph, kind: str) -> None:
    """No name of a node's workings is in their way: each is called, and the node stops."""
    body: dict[str, Any] = {name: named(name, kind) for name in NAMES}
    node: Any = type("Free", (Node,), {**body, "said": []})()
    await graph.start(node)
    for name in NAMES:
        if kind == "service":
            await graph.call(Empty, f"/{name}", Empty.Request())
        elif kind == "subscription":
            graph.publisher(Int32, f"/{name}").publish(Int32())
        elif kind == "action":
            client = graph.action_client(Fibonacci, f"/{name}")
            await graph.settle()
            await (await client.send_goal(Fibonacci.Goal())).result()
    await graph.clock.advance(1.0)
    assert node.said == [*NAMES]

    await graph.stop(node)
    assert not node.is_running
    assert not any("free" in token for token in graph.network.tokens)


async def test_attributes_may_be_called_as_they_like(graph: Graph) -> None:
    """Except the few that every node has, which are reported at the start."""

    class Busy(Node):
        def __init__(self) -> None:
            super().__init__()
            self.tasks = ["wash up"]
            self.id, self.runners, self.held = 7, "two", None

        @task
        async def work(self) -> None:
            self.tasks.append("dry")

    busy = Busy()
    await graph.start(busy)
    await graph.stop(busy)
    assert (busy.tasks, busy.id, busy.runners, busy.held) == (["wash up", "dry"], 7, "two", None)

    class Hiding(Node):
        def __init__(self) -> None:
            super().__init__()
            self.log = ["wash up"]  # type: ignore[assignment]

    with pytest.raises(DeclarationError, match=r"Hiding: every node has self\.log; choose another name"):
        await graph.start(Hiding())
