"""A node's names, its life, and its end."""

from __future__ import annotations

import asyncio
import logging
import threading
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
    subscription,
    task,
    timer,
)
from graphflow.errors import ClosedError, InvalidName
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String
from graphflow.names import Remap
from graphflow.runtime import core
from graphflow.runtime.context import Context
from graphflow.runtime.core import core_of
from graphflow.testing import Graph
from graphflow.transport.memory import MemorySession
from graphflow.wire.liveliness import Kind


class Talker(Node):
    """Has a name of every kind."""

    rate = Param(1.0, gt=0.0)
    chatter = Publisher(String, "chatter")
    private = Publisher(String, "~/private")
    absolute = Publisher(String, "/absolute")
    adder = Client(AddTwoInts, "add")


# names


@pytest.mark.parametrize(
    ("given", "full", "chatter", "private"),
    [
        ({}, "/talker", "/chatter", "/talker/private"),
        ({"name": "bob"}, "/bob", "/chatter", "/bob/private"),
        ({"namespace": "/a/b"}, "/a/b/talker", "/a/b/chatter", "/a/b/talker/private"),
        ({"namespace": "a"}, "/a/talker", "/a/chatter", "/a/talker/private"),
        ({"remap": ["__node:=eve", "__ns:=/c"]}, "/c/eve", "/c/chatter", "/c/eve/private"),
        ({"remap": ["chatter:=news"], "namespace": "/a"}, "/a/talker", "/a/news", "/a/talker/private"),
        ({"remap": ["/chatter:=/x/y"]}, "/talker", "/x/y", "/talker/private"),
        ({"remap": [Remap("chatter", "~/mine")]}, "/talker", "/talker/mine", "/talker/private"),
        ({"remap": ["~/private:=open"]}, "/talker", "/chatter", "/open"),
        ({"remap": ["talker:chatter:=news"]}, "/talker", "/news", "/talker/private"),
        ({"remap": ["rostopic://chatter:=news"]}, "/talker", "/news", "/talker/private"),
    ],
)
def test_names_are_resolved(given: dict[str, Any], full: str, chatter: str, private: str) -> None:
    """Namespace, node name and remaps give every endpoint its full name; an absolute one stays."""
    node = Talker(**given)

    assert node.full_name == full
    assert node.chatter.name == chatter
    assert node.private.name == private
    assert node.absolute.name == "/absolute"


def test_services_are_remapped_too() -> None:
    """A rule for one kind of name leaves the other alone."""
    assert Talker(remap=["add:=sum"]).adder.name == "/sum"
    assert Talker(remap=["rosservice://add:=sum"]).adder.name == "/sum"
    assert Talker(remap=["rostopic://add:=sum"]).adder.name == "/add"


@pytest.mark.parametrize("given", [{"name": "a/b"}, {"name": "1"}, {"namespace": "/a//b"}, {"remap": ["a:="]}])
def test_wrong_names_are_refused(given: dict[str, Any]) -> None:
    """A node is not made with a name that no ROS 2 node may have."""
    with pytest.raises(InvalidName):
        Talker(**given)


async def test_a_running_node_announces_its_names(graph: Graph) -> None:
    """The graph shows the node and every endpoint under its full name, and nothing of it after the stop."""
    node = Talker(namespace="/a", remap=["chatter:=/news"], start_parameter_services=False)
    await graph.start(node)
    cache = node.context.cache

    assert cache.nodes() == ["/a/talker"]
    assert [e.name for e in cache.endpoints(Kind.PUBLISHER)] == [
        "/a/talker/private",
        "/absolute",
        "/news",
        "/rosout",
    ]
    assert [e.name for e in cache.endpoints(Kind.CLIENT)] == ["/a/add"]
    assert repr(node) == "<Talker /a/talker running>"

    await graph.stop(node)

    assert graph.network.tokens == {}
    assert repr(node) == "<Talker /a/talker>"
    assert not node.is_running


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


# parameters


def test_values_from_outside() -> None:
    """By keyword or by name with a source; what is given directly holds."""
    assert Talker(rate=2).rate == 2.0
    node = Talker(overrides={"rate": (3, "graph.yaml:7")})
    assert node.rate == 3.0
    assert node.parameters.source("rate") == "graph.yaml:7"
    assert Talker(overrides={"rate": (3, "graph.yaml:7")}, rate=4).rate == 4.0


def test_a_wrong_value_is_refused_when_the_node_is_made() -> None:
    """With the place where it was written."""
    with pytest.raises(ParameterError, match=r"'rate' = 0.0 is out of range: more than 0 \(from graph.yaml:7\)"):
        Talker(overrides={"rate": (0, "graph.yaml:7")})


async def test_an_unknown_parameter_is_refused_at_the_start(graph: Graph) -> None:
    """A node may declare parameters until then; what is left over is a mistake, and nothing is left open."""
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


# life


async def test_a_node_is_started_once(graph: Graph) -> None:
    """Neither while it runs nor after it was stopped."""
    node = Talker()
    await graph.start(node)
    with pytest.raises(ClosedError, match="node /talker is running already"):
        await graph.start(node)
    await graph.stop(node)
    with pytest.raises(ClosedError, match="node /talker has been stopped; make a new one"):
        await graph.start(node)


async def test_a_node_that_did_not_call_its_parent(graph: Graph) -> None:
    """A forgotten `super().__init__()` is said in those words."""

    class Forgetful(Node):
        def __init__(self) -> None:
            self.x = 1

    with pytest.raises(DeclarationError, match=r"Forgetful\.__init__ must call super\(\)\.__init__"):
        await graph.start(Forgetful())


async def test_what_is_not_running_has_no_context(graph: Graph) -> None:
    """Asked for it, a node says that it is not running."""
    with pytest.raises(ClosedError, match="node /talker is not running"):
        Talker().clock  # noqa: B018


async def test_a_start_that_fails_leaves_nothing_open(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """The error comes out, and what was announced is withdrawn."""

    def refuse(*_: object) -> None:
        raise GraphflowError("no callers here")

    monkeypatch.setattr(MemorySession, "open_caller", refuse)
    node = Talker()
    with pytest.raises(GraphflowError, match="no callers here"):
        await graph.start(node)

    assert graph.network.tokens == {}
    assert not any(graph.network.senders.values())
    assert not node.is_running


async def test_what_is_created_while_it_runs_is_open_at_once(graph: Graph) -> None:
    """And remapped like what was declared."""
    node = Talker(remap=["late:=later"])
    await graph.start(node)
    heard = graph.tap(String, "/later")
    node.create_publisher(String, "late").publish(String(data="x"))
    await graph.settle()

    assert [m.data for m in heard] == ["x"]


async def test_work_in_a_thread(graph: Graph) -> None:
    """`offload` gives the function's result or its error, and the loop is free meanwhile."""
    node = Talker()
    await graph.start(node)

    assert await node.offload(pow, 2, 10) == 1024
    assert await node.offload(threading.get_ident) != threading.get_ident()
    with pytest.raises(ZeroDivisionError):
        await node.offload(divmod, 1, 0)


async def test_an_unused_remap_is_said(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A rule that matches nothing is most likely misspelt; the nearest name is offered."""
    await graph.start(Talker(remap=["chater:=news", "chatter:=talk", "other:x:=y"]))

    [record] = caplog.records
    assert record.levelno == logging.WARNING
    assert record.getMessage() == ("the remap chater:=news matches no name of this node; did you mean 'chatter'?")


@pytest.mark.parametrize(("names", "warned"), [(True, False), (("*/pose",), False), (("other",), True)])
async def test_a_remap_of_a_name_made_later(
    graph: Graph, caplog: pytest.LogCaptureFixture, names: Any, warned: bool
) -> None:
    """A class that makes names at run time says so, and a rule for one of them is not called unused."""
    made: Any = type("Maker", (Node,), {"dynamic_names": names})

    await graph.start(made(remap=["turtle1/pose:=here"]))

    assert bool(caplog.records) is warned


# tasks


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
    """Its error is logged with the traceback and comes to whoever waits for the node."""

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
    """It says what to do, and its traceback would only hide that."""

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
    assert record.getMessage().startswith("task /caller.work: nobody offers the service /add")
    assert record.exc_info is None


async def test_the_first_failure_counts(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A second task's error changes nothing, and asyncio does not complain of it."""

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
    """Whoever waits for it goes on, and may stop it; a second call is harmless."""

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


# the end


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
    """There is nothing to do."""
    await core_of(Talker()).stop()


@pytest.mark.parametrize("what", ["task", "subscription"])
async def test_what_does_not_end_is_named(
    graph: Graph, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    """A cleanup that takes too long does not hold the stop for ever, and the log says whose it is."""
    monkeypatch.setattr(core, "STOP_LIMIT", 0.001)
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
    """Let what was stuck find that its node is gone."""
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
    """Whoever waits for its end is cancelled with it."""
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
    """It takes the function and not the coroutine, so that nothing is left over when it refuses."""

    async def work() -> None: ...

    with pytest.raises(ClosedError):
        Talker().spawn(work)
