"""Groups, as the handlers of a node share them."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from typing import Any

import pytest

from graphflow import (
    CallError,
    CallTimeout,
    DeadlockError,
    DeclarationError,
    Group,
    Node,
    ServerBusy,
    service,
    subscription,
    timer,
)
from graphflow.interface import DeadlockPolicy, GroupChange, WhenFull
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.rcl_interfaces.srv import ListParameters
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from tests.runtime.cast import Log
from tests.until import eventually


async def test_each_group_is_one_group(graph: Graph) -> None:
    """Temporary groups stay distinct even if one reuses another's memory address."""
    node, gate = Node("n"), asyncio.Event()
    running: list[int] = []

    def make(n: int) -> Callable[[String], Any]:
        async def handler(_: String) -> None:
            running.append(n)
            await gate.wait()

        return handler

    for n in range(8):
        node.create_subscription(String, "x", make(n), group=Group(1))
    await graph.start(node)
    graph.publisher(String, "/x").publish(String())
    await graph.settle()

    assert sorted(running) == list(range(8))
    gate.set()


@pytest.mark.parametrize(("limit", "together"), [(1, 1), (2, 2), (None, 4)])
async def test_a_declared_group_holds_for_its_node(graph: Graph, limit: int | None, together: int) -> None:
    """Handlers of one group exclude each other up to its limit, separately for each node."""
    peak: dict[str, int] = {}
    gate = asyncio.Event()

    class Crowd(Node):
        crowd = Group(limit)

        async def go_in(self) -> None:
            peak[self.name] = peak.get(self.name, 0) + 1
            await gate.wait()

        @subscription(String, "x", group=crowd)
        async def first(self, _: String) -> None:
            await self.go_in()

        @subscription(String, "x", group=crowd)
        async def second(self, _: String) -> None:
            await self.go_in()

    await graph.start(Crowd("one"), Crowd("two"))
    for _ in range(2):
        graph.publisher(String, "/x").publish(String())
    await graph.settle()

    assert peak == {"one": together, "two": together}
    gate.set()


def test_a_default_group_that_is_none() -> None:
    """The error has the declaration."""
    with pytest.raises(DeclarationError, match=r"default_group is of the class Group: write .* = Group\(1\)"):

        class Wrong(Node):
            default_group = Group  # type: ignore[assignment]

            @subscription(String, "x")
            async def first(self, _: String) -> None:
                """Do nothing."""


async def test_the_default_group_of_a_class(graph: Graph) -> None:
    """`default_group = Group(1)` is rclpy's default: no two handlers of the node overlap."""
    log, gate = Log(), asyncio.Event()

    class Classic(Node):
        default_group = Group(1)

        @subscription(String, "x")
        async def first(self, _: String) -> None:
            log("first")
            await gate.wait()

        @subscription(String, "x")
        async def second(self, _: String) -> None:
            log("second")

    node = Classic()
    await graph.start(node)
    graph.publisher(String, "/x").publish(String())
    await graph.settle()
    assert log == ["first"]

    # Parameter services are never held up by a group of the user's.
    await graph.call(ListParameters, "/classic/list_parameters", ListParameters.Request())
    gate.set()
    await graph.settle()
    assert log == ["first", "second"]


class Narcissus(Node):
    """Calls itself."""

    default_group = Group(1)

    def __init__(self) -> None:
        super().__init__()
        self.client = self.create_client(AddTwoInts, "add")
        self.outcome = Log()

    @service(AddTwoInts, "add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)

    @subscription(String, "x")
    async def ask(self, _: String) -> None:
        try:
            self.outcome(await self.client.call(AddTwoInts.Request(), timeout=1.0))
        except CallError as error:
            self.outcome(type(error))


@pytest.mark.parametrize(
    ("policy", "outcome", "elapsed"),
    [("raise", DeadlockError, 0.0), ("report", CallTimeout, 1.0), ("off", CallTimeout, 1.0)],
)
async def test_a_call_to_oneself_in_one_group(
    graph: Graph, policy: DeadlockPolicy, outcome: type[CallError], elapsed: float
) -> None:
    """A slot is occupied across every await, so the call cannot be answered: it fails at once, or at its deadline."""
    graph.deadlock = policy
    node = Narcissus()
    await graph.start(node)
    graph.publisher(String, "/x").publish(String())
    await graph.settle()
    assert bool(node.outcome) is (elapsed == 0.0)
    await graph.clock.advance(elapsed)

    assert node.outcome == [outcome]


class Worker(Node):
    """Works on each message for as long as the test likes."""

    work = Group(1)

    def __init__(self, when_full: WhenFull = "wait", **options: Any) -> None:
        changes = {"work": GroupChange(when_full=when_full)}
        super().__init__("worker", concurrency=changes, **options)
        self.begun = Log()
        self.gate = asyncio.Event()
        self.ended = Log()

    @subscription(String, "x", group=work)
    async def first(self, message: String) -> None:
        await self.run(message.data)

    @service(AddTwoInts, "add", group=work)
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        await self.run("add")
        return AddTwoInts.Response()

    async def run(self, what: str) -> None:
        self.begun(what)
        try:
            await self.gate.wait()
            self.ended(what)
        except asyncio.CancelledError:
            self.ended(f"{what} cancelled")
            raise


async def say(graph: Graph, *words: str) -> None:
    for word in words:
        graph.publisher(String, "/x").publish(String(data=word))
        await graph.settle()


@pytest.mark.parametrize(
    ("when_full", "begun", "ended", "dropped"),
    [
        ("wait", ["a", "b", "c"], ["a", "b", "c"], 0),
        ("drop_new", ["a"], ["a"], 2),
        ("drop_old", ["a", "c"], ["a", "c"], 1),
        ("cancel_running", ["a", "b", "c"], ["a cancelled", "b cancelled", "c"], 0),
    ],
)
async def test_what_becomes_of_work_that_finds_its_group_full(
    graph: Graph, when_full: WhenFull, begun: list[str], ended: list[str], dropped: int
) -> None:
    """It waits, is dropped, or replaces waiting or running work; drops are counted."""
    node = Worker(when_full)
    await graph.start(node)
    await say(graph, "a", "b", "c")
    node.gate.set()
    await graph.settle()

    assert node.begun == begun
    assert node.ended == ended
    assert node.statistics()["subscription /x"]["dropped"] == dropped
    assert core_of(node).groups.by_name["work"].running == 0


@pytest.mark.parametrize("when_full", ["drop_new", "drop_old"])
async def test_a_request_that_is_dropped_is_refused(graph: Graph, when_full: WhenFull) -> None:
    """The caller gets an error, whichever request is dropped."""
    node = Worker(when_full)
    await graph.start(node)
    await say(graph, "a")
    calls = [asyncio.ensure_future(graph.call(AddTwoInts, "/add", AddTwoInts.Request())) for _ in range(2)]
    await graph.settle()
    refused = calls if when_full == "drop_new" else calls[:1]
    for call in refused:
        with pytest.raises(ServerBusy, match="/add runs in a group that is full and drops requests"):
            await call
    node.gate.set()
    await graph.settle()
    assert all(call.done() for call in calls)


async def test_newer_work_of_another_member_displaces_what_waits(graph: Graph) -> None:
    """`drop_old` keeps the newest of the whole group, not of each member."""
    node = Worker("drop_old")
    await graph.start(node)
    await say(graph, "a", "b")
    call = asyncio.ensure_future(graph.call(AddTwoInts, "/add", AddTwoInts.Request()))
    await graph.settle()
    node.gate.set()
    await call

    assert node.begun == ["a", "add"]


async def test_a_slot_can_be_released_for_a_while(graph: Graph) -> None:
    """Other handlers of the group run, and the handler returns at the tail of the queue."""
    log, gate, busy = Log(), asyncio.Event(), asyncio.Event()

    class Polite(Node):
        motion = Group(1)

        @subscription(String, "x", group=motion)
        async def slow(self, _: String) -> None:
            log("begins")
            async with self.group.released():
                await gate.wait()
                log("wants back")
            log("is back")

        @subscription(String, "y", group=motion)
        async def other(self, _: String) -> None:
            log("other")
            await busy.wait()
            log("other ends")

    node = Polite()
    await graph.start(node)
    await say(graph, "go")
    graph.publisher(String, "/y").publish(String())
    await graph.settle()
    gate.set()
    await graph.settle()
    assert log == ["begins", "other", "wants back"]
    busy.set()
    await graph.settle()

    assert log == ["begins", "other", "wants back", "other ends", "is back"]
    assert node.motion.running == 0


async def test_a_cancelled_handler_comes_back_before_its_cleanup(graph: Graph) -> None:
    """The group also protects the cleanup against handlers that ran in between; then the handler ends as cancelled."""
    log, busy = Log(), asyncio.Event()

    class Polite(Node):
        motion = Group(1, "cancel_running")

        @subscription(String, "x", group=motion)
        async def slow(self, _: String) -> None:
            try:
                async with self.motion.released():
                    await asyncio.Event().wait()
            finally:
                log("cleans up")

        @subscription(String, "y", group=motion)
        async def other(self, _: String) -> None:
            await busy.wait()
            log("other ends")

    node = Polite()
    await graph.start(node)
    await say(graph, "go")
    graph.publisher(String, "/y").publish(String())
    await graph.settle()
    stopped = asyncio.ensure_future(graph.stop(node))
    await graph.settle()
    assert log[:1] == ["cleans up"]
    await stopped

    assert node.motion.running == 0


async def test_only_the_handler_itself_can_release_its_slot(graph: Graph) -> None:
    """A task that it started, and code outside handlers, get an error."""
    log = Log()

    class Rude(Node):
        motion = Group(1)
        other = Group(1)

        @subscription(String, "x", group=motion)
        async def handle(self, _: String) -> None:
            for group in (self.motion, self.other):
                try:
                    await asyncio.create_task(self.let_go(group))
                except RuntimeError as error:
                    log(str(error))

        async def let_go(self, group: Any) -> None:
            async with group.released():
                log("released")

    node = Rude()
    await graph.start(node)
    await say(graph, "go")

    assert len(log) == 2
    assert all("cannot be released here: only a handler that runs in it can do that" in text for text in log)
    with pytest.raises(RuntimeError, match="not a handler that holds a slot"):
        _ = node.group


async def test_a_graph_file_moves_handlers(graph: Graph) -> None:
    """Into groups of its own, into declared ones with other limits, and out of all."""

    class Mixed(Node):
        io = Group(None)

        @subscription(String, "x", group=io)
        async def a(self, _: String) -> None:
            """Handle nothing."""

        @subscription(String, "x", group=io)
        async def b(self, _: String) -> None:
            """Handle nothing."""

        @timer(1.0)
        async def c(self) -> None:
            """Do nothing."""

    changes = {
        "own": GroupChange(("a", "c"), 2, sets_limit=True),
        "none": GroupChange(("b",)),
        "io": GroupChange((), 3, sets_limit=True),
    }
    node = Mixed(concurrency=changes)
    await graph.start(node)

    groups = core_of(node).groups.by_name
    assert {name: group.limit for name, group in groups.items()} == {"io": 3, "own": 2}
    assert [member.name for member in groups["own"].members] == ["/mixed.a", "/mixed.c"]  # type: ignore[attr-defined]
    assert not groups["io"].members


async def test_a_graph_file_that_names_what_is_not_there(graph: Graph) -> None:
    """An unknown handler and one in two groups are errors with the nearest name."""
    with pytest.raises(DeclarationError, match="first is put in two groups, 'a' and 'b'"):
        Node("n", concurrency={"a": GroupChange(("first",)), "b": GroupChange(("first",))})
    with pytest.raises(DeclarationError, match="'frist', which is not a handler of this node; did you mean 'first'"):
        await graph.start(MisplacedWorker())


class MisplacedWorker(Worker):
    def __init__(self) -> None:
        Node.__init__(self, concurrency={"work": GroupChange(("frist",))})


async def test_blocking_handlers_of_a_threaded_group_hold_the_slot_and_not_the_loop(graph: Graph) -> None:
    """The loop goes on while a `def` of the group blocks in its thread."""
    entered, gate = asyncio.Event(), threading.Event()

    class Blocking(Node):
        heavy = Group(1, thread=True)

        @subscription(String, "x", group=heavy)
        def work(self, _: String) -> None:
            self.context.loop.call_soon_threadsafe(entered.set)
            assert gate.wait(10.0)

    node = Blocking()
    graph.waits_outside = False
    await graph.start(node)
    await say(graph, "go")
    await entered.wait()
    assert node.heavy.running == 1
    gate.set()
    await eventually(lambda: not node.heavy.running)


def test_an_error_budget_that_is_none() -> None:
    """The error has the declaration."""
    with pytest.raises(DeclarationError, match=r"error_budget is of the class ErrorBudget: write error_budget = Error"):

        class Wrong(Node):
            error_budget = 5  # type: ignore[assignment]
