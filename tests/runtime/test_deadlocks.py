"""Deadlocks as they happen, and programs that look like them: what is reported, once, with the right line; what never.

The first part goes through the matrix of the concurrency design, row by row; "row 5" in a docstring is its number
there. The second is what students write, the third the same programs with a way out.

A program's flag has a name that no other code of this file uses on anything but `self`: whatever is written to from
outside its class counts as open to the world, and nothing is ever said of it.
"""

from __future__ import annotations

import asyncio
import itertools
import json
import math
import threading
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import monotonic_ns
from typing import Any, NamedTuple

import pytest

from graphflow import (
    ActionClient,
    CallError,
    CallTimeout,
    Client,
    DeadlockError,
    GoalCanceled,
    GoalRejected,
    Group,
    Node,
    Param,
    ServerBusy,
    Subscription,
    action,
    service,
    subscription,
    task,
    timer,
)
from graphflow.interface import DeadlockPolicy, GroupChange, WhenFull
from graphflow.machines.picture import from_json, to_json
from graphflow.machines.waits import deadlocked, explained
from graphflow.msgs import registry
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.runtime import detector
from graphflow.runtime.clock import Clock
from graphflow.testing import Graph
from graphflow.transport.base import Answer
from graphflow.wire import attachment, chain
from tests.runtime.cast import Log

FILE = Path(__file__).name
Caplog = pytest.LogCaptureFixture


def line_of(marker: str) -> int:
    """The line of this file that ends with the marker."""
    lines = Path(__file__).read_text(encoding="utf-8").splitlines()
    [number] = [n for n, line in enumerate(lines, 1) if line.endswith(f"# {marker}")]
    return number


def at(marker: str) -> str:
    """How a report tells that line."""
    return f"({FILE}:{line_of(marker)} in "


def reports(caplog: Caplog) -> list[str]:
    """The deadlocks that were reported so far; nothing may have failed in the background."""
    assert not [r for r in caplog.records if r.name == "asyncio"]
    texts = [r.getMessage() for r in caplog.records if r.name == "graphflow" and r.levelname == "ERROR"]
    assert all(text.startswith(("DEADLOCK: ", "LIKELY DEADLOCK: ")) for text in texts)
    return texts


def the_report(caplog: Caplog) -> str:
    """The only one."""
    texts = reports(caplog)
    assert len(texts) == 1
    return texts[0]


def cleared(caplog: Caplog) -> list[str]:
    """The deadlocks that were said to be over."""
    return [m for m in (r.getMessage() for r in caplog.records) if m.endswith("has cleared")]


async def say(graph: Graph, *topics: str) -> None:
    for topic in topics:
        graph.publisher(String, topic).publish(String())
        await graph.settle()


def wrong(reason: str) -> pytest.MarkDecorator:
    """What graphflow does not do yet."""
    return pytest.mark.xfail(strict=True, raises=AssertionError, reason=reason)


# The matrix


class Narcissus(Node):
    """Calls itself once a second."""

    work = Group(1)
    mirror = Client(Empty, "mirror")

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.outcomes = Log()

    @service(Empty, "mirror", group=work)
    async def answer(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    @timer(1.0, group=work)
    async def tick(self) -> None:
        try:
            self.outcomes(await self.mirror.call(Empty.Request(), timeout=8.0))  # stuck: Narcissus
        except CallError as error:
            self.outcomes(error)


async def test_a_timer_that_calls_the_service_of_its_own_group(graph: Graph, caplog: Caplog) -> None:
    """It is reported a quarter of a second later, with the line, the deadline and a way out (row 1)."""
    graph.deadlock = "report"
    await graph.start(Narcissus())
    await graph.clock.advance(1.24)
    assert reports(caplog) == []
    await graph.clock.advance(0.02)

    text = the_report(caplog)
    assert text.startswith("DEADLOCK: one callback waits for itself\n  timer tick of /narcissus holds group 'work'")
    assert f"/mirror   {at('stuck: Narcissus')}tick, since 0.25 s, times out in 7.8 s)\n" in text
    assert "service answer of /narcissus waits for group 'work' of /narcissus, which timer tick" in text
    assert "/narcissus: {concurrency: {answer_group: [answer]}}" in text
    await graph.clock.advance(7.0)
    assert reports(caplog) == [text]


async def test_the_same_fails_at_once(graph: Graph, caplog: Caplog) -> None:
    """The call ends without time passing, with the explanation, and nothing is left to report (row 1)."""
    node = Narcissus()
    await graph.start(node)
    await graph.clock.advance(1.0)

    [error] = node.outcomes
    assert isinstance(error, DeadlockError)
    assert "/mirror can never answer: service answer of /narcissus waits for group 'work'" in str(error)
    assert f"held by timer tick of /narcissus   {at('stuck: Narcissus')}tick" in str(error)
    await graph.clock.advance(0.9)
    assert reports(caplog) == []


async def test_the_advice_helps(graph: Graph, caplog: Caplog) -> None:
    """The group that the report tells to write into the graph file ends it (row 2)."""
    node = Narcissus(concurrency={"answer_group": GroupChange(("answer",))})
    await graph.start(node)
    await graph.clock.advance(3.5)

    assert node.outcomes == [Empty.Response()] * 3
    assert reports(caplog) == []


class Peer(Node):
    """Asks another, after a while, from the group in which it answers too."""

    work = Group(1)

    def __init__(self, name: str, other: str, delay: float = 0.2, timeout: float | None = 8.0, **options: Any) -> None:
        super().__init__(name, **options)
        self.other = self.create_client(Empty, f"/{other}/answer")
        self.delay, self.timeout = delay, timeout
        self.outcomes = Log()

    @subscription(String, "go", group=work)
    async def ask(self, _: String) -> None:
        await self.clock.sleep(self.delay)
        try:
            await self.other.call(Empty.Request(), timeout=self.timeout)  # stuck: Peer
            self.outcomes("answered")
        except CallError as error:
            self.outcomes(type(error))

    @service(Empty, "~/answer", group=work)
    async def answer(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


def ring_of(names: str, **options: Any) -> list[Peer]:
    """Peers of which each asks the next, and the last the first."""
    return [Peer(name, other, **options) for name, other in zip(names, names[1:] + names[0], strict=True)]


@pytest.mark.parametrize("names", ["ab", "abc", "abcde"])
@pytest.mark.parametrize("policy", ["report", "raise"])
async def test_a_ring_through_several_processes(
    graph: Graph, caplog: Caplog, names: str, policy: DeadlockPolicy
) -> None:
    """All members find it, one reports it, and no call is ended: each might have been answered (rows 3, 6, 29)."""
    graph.deadlock = policy
    peers = ring_of(names)
    await graph.start(*peers)
    await say(graph, "/go")
    await graph.clock.advance(0.5)
    text = the_report(caplog)

    assert text.startswith(f"DEADLOCK: {len(names)} callbacks wait for each other in a ring\n")
    assert text.count(at("stuck: Peer")) == len(names)
    for peer in peers:
        mine, other = peer.full_name, peer.other.name.removesuffix("/answer")
        assert f"subscription ask of {mine} holds group 'work' and waits for the answer of service {other}/ans" in text
        assert f"service answer of {other} waits for group 'work' of {other}, which subscription ask" in text
    await graph.clock.advance(7.0)
    assert reports(caplog) == [text]
    assert all(peer.context.detector.pulls > 1 and peer.outcomes == [] for peer in peers)


async def test_peers_that_answer_in_a_group_of_its_own(graph: Graph, caplog: Caplog) -> None:
    """The same calls are answered (row 4)."""
    peers = ring_of("ab", concurrency={"answers": GroupChange(("answer",))})
    await graph.start(*peers)
    await say(graph, "/go")
    await graph.clock.advance(8.0)

    assert [peer.outcomes for peer in peers] == [["answered"]] * 2
    assert reports(caplog) == []


class Echo(Node):
    """Is asked by another to ask it back."""

    work = Group(1)

    def __init__(self, name: str, other: str) -> None:
        super().__init__(name)
        self.forward = self.create_client(Empty, f"/{other}/forward")
        self.back = self.create_client(Empty, f"/{other}/answer")
        self.outcomes = Log()

    @subscription(String, "~/go", group=work)
    async def ask(self, _: String) -> None:
        try:
            await self.forward.call(Empty.Request())  # stuck: Echo asks
        except CallError as error:
            self.outcomes(error)

    @service(Empty, "~/forward", group=work)
    async def on_forward(self, request: Empty.Request) -> Empty.Response:
        await self.back.call(Empty.Request())  # stuck: Echo asks back
        return Empty.Response()

    @service(Empty, "~/answer", group=work)
    async def answer(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


async def test_a_service_that_calls_its_caller_back(graph: Graph, caplog: Caplog) -> None:
    """The chain is known on arrival: the innermost call fails at once, and its error travels back (row 5)."""
    a, b = Echo("a", "b"), Echo("b", "a")
    await graph.start(a, b)
    await say(graph, "/a/go")

    [error] = a.outcomes
    assert isinstance(error, DeadlockError)
    assert "/a/answer can never answer: service answer of /a waits for group 'work' of /a, held by subs" in str(error)
    assert at("stuck: Echo asks") in str(error)
    await graph.clock.advance(5.0)
    assert reports(caplog) == []


async def test_a_service_that_calls_its_caller_back_is_reported(graph: Graph, caplog: Caplog) -> None:
    """Where nothing is raised, both lines of the chain are told (row 5)."""
    graph.deadlock = "report"
    await graph.start(Echo("a", "b"), Echo("b", "a"))
    await say(graph, "/a/go")
    await graph.clock.advance(8.0)

    text = the_report(caplog)
    assert text.startswith("DEADLOCK: 2 callbacks wait for each other in a ring\n")
    assert at("stuck: Echo asks") in text
    assert at("stuck: Echo asks back") in text
    assert "service answer of /a waits for group 'work' of /a, which subscription ask of /a holds" in text


class Recursive(Node):
    """A service that calls itself, so deep."""

    answers = Group(None)
    itself = Client(Empty, "again")

    def __init__(self, depth: int, limit: int) -> None:
        super().__init__(concurrency={"answers": GroupChange((), limit, sets_limit=True)})
        self.depth = depth
        self.outcomes = Log()

    @service(Empty, "again", group=answers)
    async def again(self, request: Empty.Request) -> Empty.Response:
        self.depth -= 1
        if self.depth >= 0:
            await self.itself.call(Empty.Request())  # stuck: Recursive
        return Empty.Response()

    @subscription(String, "go")
    async def go(self, _: String) -> None:
        try:
            await self.itself.call(Empty.Request())
            self.outcomes("answered")
        except CallError as error:
            self.outcomes(type(error))


@pytest.mark.parametrize(("depth", "limit", "fits"), [(0, 1, True), (1, 1, False), (1, 2, True), (2, 2, False)])
@pytest.mark.parametrize("policy", ["report", "raise"])
async def test_recursion(
    graph: Graph, caplog: Caplog, depth: int, limit: int, fits: bool, policy: DeadlockPolicy
) -> None:
    """A group with n slots bears n - 1 calls of itself inside each other; with one slot it is a mutex (rows 7, 8)."""
    graph.deadlock = policy
    node = Recursive(depth, limit)
    await graph.start(node)
    await say(graph, "/go")
    await graph.clock.advance(8.0)

    assert node.outcomes == (["answered"] if fits else [DeadlockError] if policy == "raise" else [])
    found = reports(caplog)
    assert len(found) == (not fits and policy == "report")
    for text in found:
        assert at("stuck: Recursive") in text
        assert f"answers: {{limit: {limit + 1}}}" in text


class Sleeper(Node):
    """Serves for four seconds, one after the other."""

    work = Group(1)

    @service(Empty, "slow", group=work)
    async def slow(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(4.0)
        return Empty.Response()


class Caller(Node):
    """Holds a group for as long as a call takes."""

    work = Group(1)
    slow = Client(Empty, "slow")

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.outcomes = Log()

    @subscription(String, "go", group=work)
    async def ask(self, _: String) -> None:
        await self.slow.call(Empty.Request(), timeout=20.0)
        self.outcomes("answered")


async def test_what_takes_long_lives(graph: Graph, caplog: Caplog) -> None:
    """Callers that queue for a server that sleeps are looked at often, and never reported (row 9)."""
    callers = [Caller(name) for name in "abc"]
    await graph.start(Sleeper(), *callers)
    await say(graph, "/go")
    for _ in range(200):
        await graph.clock.advance(0.1)

    assert [caller.outcomes for caller in callers] == [["answered"]] * 3
    assert all(caller.context.detector.pulls > 2 for caller in callers)
    assert reports(caplog) == []


async def test_a_call_that_nobody_awaits(graph: Graph, caplog: Caplog) -> None:
    """The handler gives its slot back, so that the answer comes, late (row 15)."""

    class Careless(Node):
        work = Group(1)
        ping = Client(Empty, "ping")
        answers = Log()

        @service(Empty, "ping", group=work)
        async def on_ping(self, request: Empty.Request) -> Empty.Response:
            return Empty.Response()

        @subscription(String, "go", group=work)
        async def go(self, _: String) -> None:
            asking = asyncio.ensure_future(self.ping.call(Empty.Request()))
            asking.add_done_callback(lambda asked: self.answers(asked.result()))
            await self.clock.sleep(2.0)

    node = Careless()
    await graph.start(node)
    await say(graph, "/go")
    await graph.clock.advance(1.9)
    assert node.answers == []
    await graph.clock.advance(0.1)

    assert node.answers == [Empty.Response()]
    assert reports(caplog) == []


async def test_who_queues_behind_a_ring_is_a_victim(graph: Graph, caplog: Caplog) -> None:
    """It is named, and not as a part of the ring (row 16)."""
    await graph.start(*ring_of("ab"), Peer("late", "a", delay=0.1))
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    text = the_report(caplog)
    assert text.startswith("DEADLOCK: 2 callbacks wait for each other in a ring; 1 more wait")
    assert f"\n  behind them: subscription ask of /late   {at('stuck: Peer')}ask, since 0.3" in text
    assert "holds group 'work' of /late" not in text


@wrong("a ring within one process is explained from its own picture: it does not see who waits in others")
async def test_who_queues_behind_a_ring_of_another_process_is_a_victim(graph: Graph, caplog: Caplog) -> None:
    """Whoever is stuck is named, wherever the ring is (row 16)."""
    graph.deadlock = "report"
    late = Node("late")
    asking = late.create_client(Empty, "mirror")

    async def ask(_: String) -> None:
        await asking.call(Empty.Request())

    late.create_subscription(String, "go", ask)
    await graph.start(Narcissus(), late)
    await graph.clock.advance(1.0)
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    text = the_report(caplog)
    assert "behind them: subscription ask of /late" in text


async def test_a_member_that_is_cancelled_frees_the_others(graph: Graph, caplog: Caplog) -> None:
    """The report clears, the slots and queues are empty, and nothing is made of what is left (row 18)."""
    graph.deadlock = "report"
    a, b = ring_of("ab", timeout=None)
    await graph.start(a, b)
    await say(graph, "/go")
    await graph.clock.advance(1.0)
    [run] = [run for runner in a.runners for run in runner.active]
    run.cancel()
    await graph.settle()
    assert (a.outcomes, b.outcomes) == ([], ["answered"])
    await graph.clock.advance(5.0)

    assert len(reports(caplog)) == 1
    assert cleared(caplog) == ["the deadlock of subscription ask of /a and subscription ask of /b has cleared"]
    for node in (a, b):
        assert (node.work.running, node.work.waiting) == (0, ())
        assert not node.context.waits.calls
        assert not node.context.detector.reports


async def test_a_member_that_times_out_frees_the_others(graph: Graph, caplog: Caplog) -> None:
    """The report says when that will be, and that it has been (row 19)."""
    a, b = Peer("a", "b", timeout=3.0), Peer("b", "a", timeout=None)
    await graph.start(a, b)
    await say(graph, "/go")
    await graph.clock.advance(1.0)
    text = the_report(caplog)
    mine, others = (line for line in text.splitlines() if at("stuck: Peer") in line and "waits for" in line)
    assert mine.endswith("times out in 2.8 s)")
    assert "times out" not in others
    await graph.clock.advance(5.0)

    assert (a.outcomes, b.outcomes) == ([CallTimeout], ["answered"])
    assert reports(caplog) == [text]
    assert len(cleared(caplog)) == 1


class Juggler(Node):
    """Always has two calls under way to its partner, which has two to it, each from a group and into a group."""

    serving, left, right = Group(1), Group(1), Group(1)

    def __init__(self, name: str, other: str) -> None:
        super().__init__(name)
        self.other = self.create_client(Empty, f"/{other}/catch")
        self.thrown = 0

    async def throw(self) -> None:
        for _ in range(400):
            await self.other.call(Empty.Request())
            self.thrown += 1

    @subscription(String, "go", group=left)
    async def with_left(self, _: String) -> None:
        await self.throw()

    @subscription(String, "go", group=right)
    async def with_right(self, _: String) -> None:
        await self.throw()

    @service(Empty, "~/catch", group=serving)
    async def catch(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(0.003)
        return Empty.Response()


async def test_churn(graph: Graph, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """Hundreds of calls that cross each other make no phantom, however often somebody looks (row 23)."""
    monkeypatch.setattr(detector, "PROBE_AFTER", 0.004)
    monkeypatch.setattr(detector, "PROBE_LONGEST", 0.005)
    a, b = Juggler("a", "b"), Juggler("b", "a")
    await graph.start(a, b)
    await say(graph, "/go")
    for _ in range(2500):
        await graph.clock.advance(0.001)

    assert (a.thrown, b.thrown) == (800, 800)
    assert min(a.context.detector.pulls, b.context.detector.pulls) > 200
    assert reports(caplog) == []


class Customer(Node):
    """Waits for a goal in the group in which it tells where it is."""

    motion = Group(1)
    order = ActionClient(Fibonacci, "order")

    def __init__(self) -> None:
        super().__init__()
        self.outcomes = Log()

    @subscription(String, "go", group=motion)
    async def go(self, _: String) -> None:
        self.sent = await self.order.send_goal(Fibonacci.Goal(order=1))
        try:
            self.outcomes(await self.sent.result())  # stuck: Customer
        except GoalCanceled as error:
            self.outcomes(type(error))

    @service(Empty, "position", group=motion)
    async def position(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


class Courier(Node):
    """Asks its customer for the way."""

    position = Client(Empty, "position")

    @action(Fibonacci, "order")
    async def deliver(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.position.call(Empty.Request(), timeout=20.0)  # stuck: Courier
        return Fibonacci.Result()


async def test_a_ring_through_the_result_of_an_action(graph: Graph, caplog: Caplog) -> None:
    """It is reported, and cancelling the goal still works: that needs no slot of the user's (row 26)."""
    customer = Customer()
    await graph.start(customer, Courier())
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    text = the_report(caplog)
    assert text.startswith("DEADLOCK: 2 callbacks wait for each other in a ring")
    assert f"group 'motion' and waits for the result of action /order   {at('stuck: Customer')}go, " in text
    assert "    -> which action deliver of /courier is to give" in text
    assert f"courier waits for the answer of service /position   {at('stuck: Courier')}deliver, " in text
    assert "service position of /customer waits for group 'motion' of /customer, which subscription go" in text
    assert await customer.sent.cancel()
    await graph.clock.advance(1.0)

    assert customer.outcomes == [GoalCanceled]
    assert (customer.motion.running, len(cleared(caplog))) == (0, 1)
    assert reports(caplog) == [text]


async def test_only_what_users_wrote_is_called_a_victim(graph: Graph, caplog: Caplog) -> None:
    """The services behind an action are not counted as callbacks that wait."""
    await graph.start(Customer(), Courier())
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    text = the_report(caplog)
    assert "1 more wait" not in text
    assert "get_result" not in text


FORGED = chain.extended(b"", chain.Hop(b"\1" * 8, 7, b"\2" * 16, 1))
CHAINS = {
    "nothing": b"",
    "too many hops": b"c\x11" + FORGED[2:] * 17,
    "fewer bytes than hops": b"c\x02" + FORGED[2:],
    "more bytes than hops": FORGED + b"\0",
    "another letter": b"x" + FORGED[1:],
    "noise": b"\xff" * 40,
    "somebody else": FORGED,
}


def holder_of(node: Node) -> int:
    """The number of the run that is under way."""
    return next(run.number for runner in node.runners for run in runner.active)


class Busy(Node):
    """Is busy for a second."""

    work = Group(1)

    @subscription(String, "go", group=work)
    async def go(self, _: String) -> None:
        await self.clock.sleep(1.0)

    @service(Empty, "answer", group=work)
    async def answer(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


@pytest.mark.parametrize(
    "told",
    [
        *(pytest.param(lambda _, told=told: told, id=name) for name, told in CHAINS.items()),
        pytest.param(lambda _: b"c", id="a letter"),
        pytest.param(
            lambda node: chain.extended(b"", chain.Hop(node.context.waits.process, holder_of(node), b"\2" * 16, 1)),
            id="the holder, who waits for something else",
        ),
    ],
)
async def test_a_chain_that_is_none(graph: Graph, caplog: Caplog, told: Callable[[Node], bytes]) -> None:
    """A request with a malformed or forged chain waits like any other, and is answered (row 30)."""
    node = Busy()
    await graph.start(node)
    await say(graph, "/go")
    session = graph.network.session(asyncio.get_running_loop())
    [key] = [key for key in graph.network.servers if "/answer/" in key]
    answers: list[Answer | None] = []
    beside = attachment.pack(1, 0, b"\2" * 16) + told(node)
    session.open_caller(key, lambda: None).call(
        registry.codec("std_srvs/srv/Empty_Request").encode(Empty.Request()), beside, answers.append
    )
    await graph.settle()
    assert answers == []
    await graph.clock.advance(1.0)

    assert [answer.is_error for answer in answers if answer is not None] == [False]
    assert reports(caplog) == []


@pytest.mark.parametrize(
    "report",
    [
        *(b"", b"\xff", b"null", b"[1]", b"{}", b'{"v": 2}', b'{"v": 1, "activities": 3, "groups": [], "queues": []}'),
        b'{"v": 1, "activities": [[1]], "groups": [], "queues": [], "blocked": {}}',
        b"[" * 100_000,
    ],
    ids=lambda report: str(report[:20]),
)
async def test_a_process_that_talks_nonsense_about_its_waits(graph: Graph, caplog: Caplog, report: bytes) -> None:
    """It is left out, and the others are looked at all the same."""
    session = graph.network.session(asyncio.get_running_loop())
    session.open_report("@graphflow/0/waits/nonsense", lambda: report)
    await graph.start(*ring_of("ab"))
    await say(graph, "/go")
    await graph.clock.advance(2.0)

    assert len(reports(caplog)) == 1


@pytest.mark.parametrize("moves", [False, True])
async def test_a_wait_that_is_not_the_same_twice(graph: Graph, caplog: Caplog, moves: bool) -> None:
    """Who has moved on between two pictures of several processes is not stuck, though both show a ring."""
    peers = ring_of("ab", timeout=None)
    await graph.start(*peers)
    other = max(peers, key=lambda peer: peer.context.session.zid)
    other.context.detector.close()
    [key] = [key for key in graph.network.reports if f"/waits/{other.context.session.zid}" in key]
    real, shown = graph.network.reports[key], itertools.count()

    def report() -> bytes:
        data = json.loads(real())
        picture = from_json(data)
        answers = f"request {next(shown) if moves else 0}"
        found = {name: replace(activity, serves=answers) for name, activity in picture.activities.items()}
        return json.dumps({**data, **to_json(replace(picture, activities=found))}).encode()

    graph.network.reports[key] = report
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    assert next(shown) > 2 or not moves
    assert len(reports(caplog)) == (not moves)


# Policies


@pytest.mark.parametrize(
    ("policy", "outcomes", "reported"),
    [
        ("off", [], 0),
        ("report", [], 1),
        ("raise", [], 1),
        ("break", ["answered", DeadlockError], 1),
    ],
)
async def test_policies(
    graph: Graph, caplog: Caplog, policy: DeadlockPolicy, outcomes: list[Any], reported: int
) -> None:
    """Only `break` ends a call of a ring that nobody could foresee, and with it the ring."""
    graph.deadlock = policy
    a, b = ring_of("ab")
    await graph.start(a, b)
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    assert sorted([*a.outcomes, *b.outcomes], key=str, reverse=True) == outcomes
    assert len(reports(caplog)) == reported
    assert len(cleared(caplog)) == (policy == "break")


async def test_a_ring_through_an_action_can_be_broken(graph: Graph, caplog: Caplog) -> None:
    """One call of it is ended with DeadlockError, whichever process has it."""
    graph.deadlock = "break"
    customer = Customer()
    await graph.start(customer, Courier())
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    assert customer.motion.running == 0
    assert len(cleared(caplog)) == 1


class Impatient(Node):
    """Serves slowly, and calls itself for five seconds at most."""

    motion = Group(1)
    slow = Client(Empty, "slow")
    ping = Client(Empty, "ping")

    @service(Empty, "ping", group=motion)
    async def on_ping(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    @subscription(String, "long")
    async def wait_long(self, _: String) -> None:
        await self.slow.call(Empty.Request(), timeout=None)

    @service(Empty, "slow")
    async def on_slow(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(100.0)
        return Empty.Response()

    @subscription(String, "go", group=motion)
    async def go(self, _: String) -> None:
        await self.ping.call(Empty.Request(), timeout=5.0)  # stuck: Impatient


async def test_an_old_wait_does_not_hide_a_new_deadlock(graph: Graph, caplog: Caplog) -> None:
    """It is found as soon as any other, though somebody has waited long for something that lives."""
    graph.deadlock = "report"
    await graph.start(Impatient())
    await say(graph, "/long")
    await graph.clock.advance(16.0)
    await say(graph, "/go")
    await graph.clock.advance(1.0)

    text = the_report(caplog)
    assert at("stuck: Impatient") in text


class Stubborn(Peer):
    """Asks again when nobody has answered."""

    async def ask(self, _: String) -> None:
        while not self.outcomes:
            try:
                await self.other.call(Empty.Request(), timeout=2.0)
                self.outcomes("answered")
            except CallTimeout:
                self.log.warning("again")


async def test_a_ring_that_opens_elsewhere_has_cleared(graph: Graph, caplog: Caplog) -> None:
    """There are never more reports at once than rings, however often one member tries again."""
    graph.deadlock = "report"
    a = Peer("a", "b", delay=0.0, timeout=None)
    await graph.start(a, Stubborn("b", "a"))
    await say(graph, "/go")
    await graph.clock.advance(7.0)

    assert len(reports(caplog)) > 1
    assert len(a.context.detector.reports) == 1


async def test_two_rings_are_two_reports(graph: Graph, caplog: Caplog) -> None:
    """Each is told once, and neither as the other's victim."""
    graph.deadlock = "report"
    await graph.start(*ring_of("ab"), *ring_of("cd"))
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    texts = reports(caplog)
    assert len(texts) == 2
    assert all("in a ring\n" in text for text in texts)
    assert ["of /a" in text for text in sorted(texts)] == [True, False]


async def test_goals_that_were_rejected_are_not_kept(graph: Graph) -> None:
    """Nobody waits for them, and nothing remembers them."""

    class Refuses(Node):
        def never(self, goal: Fibonacci.Goal) -> bool:
            return False

        @action(Fibonacci, "order", accept=never)
        async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
            return Fibonacci.Result()

    asker = Customer()
    await graph.start(Refuses(), asker)
    with pytest.raises(GoalRejected):
        await asker.order.send_goal(Fibonacci.Goal())

    assert not asker.context.waits.goals


# What students write


class Robot(Node):
    """Two handlers that exclude each other: what the programs below put into them never ends together."""

    node_name = "robot"
    motion = Group(1)

    @subscription(String, "go", group=motion)
    async def go(self, _: String) -> None:
        """Wait for something."""

    @subscription(String, "arrive", group=motion)
    async def arrive(self, _: String) -> None:
        """Bring it about."""

    def others(self) -> Sequence[Node]:
        """Further nodes that the program has."""
        return ()


class Waiter(Robot):
    """Waits for an event that another handler of the group sets."""

    def __init__(self) -> None:
        super().__init__()
        self.arrived = asyncio.Event()

    async def go(self, _: String) -> None:
        await self.arrived.wait()  # stuck: Waiter

    async def arrive(self, _: String) -> None:
        self.arrived.set()


class Driver(Robot):
    """Polls a flag that another handler of the group sets."""

    there = False

    async def go(self, _: String) -> None:
        while not self.there:
            await self.clock.sleep(0.05)  # stuck: Driver

    async def arrive(self, _: String) -> None:
        self.there = True


class Dialler(Robot):
    """Has a service in the group of its handlers, and one outside that takes a second."""

    ping = Client(Empty, "ping")
    pong = Client(Empty, "pong")

    @service(Empty, "ping", group=Robot.motion)
    async def on_ping(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    @service(Empty, "pong")
    async def on_pong(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(1.0)
        return Empty.Response()


class Planner(Robot):
    """Has an action in the group of its handlers, or that waits for them."""

    plan = ActionClient(Fibonacci, "plan")

    @action(Fibonacci, "plan", group=Robot.motion)
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        return Fibonacci.Result()


class WholeProgram(Node):
    """All in one class, as it is first written."""

    node_name = "robot"
    default_group = Group(1)

    def __init__(self) -> None:
        super().__init__()
        self.at_goal = False

    @subscription(String, "go")
    async def go(self, _: String) -> None:
        self.at_goal = False
        while not self.at_goal:
            await self.clock.sleep(0.05)  # stuck: WholeProgram

    @timer(0.1)
    async def look(self) -> None:
        self.at_goal = True


class ProgramOfRclpys(Node):
    """Everything made by hand, as in rclpy."""

    motion = Group(1)

    def __init__(self) -> None:
        super().__init__("robot")
        self.landed = False
        group = type(self).motion
        self.create_subscription(String, "go", self.on_go, 10, group=group)
        self.create_subscription(String, "arrive", self.on_arrive, 10, group=group)

    async def on_go(self, _: String) -> None:
        while not self.landed:
            await self.clock.sleep(0.05)  # stuck: ProgramOfRclpys

    async def on_arrive(self, _: String) -> None:
        self.landed = True


class EventWithin(Waiter):
    async def go(self, _: String) -> None:
        async with self.clock.timeout(5.0):
            await self.arrived.wait()  # stuck: EventWithin


class EventWaitedFor(Waiter):
    async def go(self, _: String) -> None:
        await asyncio.wait_for(self.arrived.wait(), 60.0)  # stuck: EventWaitedFor


class EventGathered(Waiter):
    async def go(self, _: String) -> None:
        await asyncio.gather(self.arrived.wait(), self.clock.sleep(60.0))  # stuck: EventGathered


class EventPolled(Waiter):
    async def go(self, _: String) -> None:
        while not self.arrived.is_set():
            await self.clock.sleep(0.05)  # stuck: EventPolled


class EventOfTheNextMessage(Waiter):
    """The handler sets it itself, at its second message, which its first run does not let in."""

    heard = 0

    async def go(self, _: String) -> None:
        """Be quick."""

    async def arrive(self, _: String) -> None:
        self.heard += 1
        if self.heard == 2:
            self.arrived.set()
        await self.arrived.wait()  # stuck: EventOfTheNextMessage


class Eater(Robot):
    """Waits at a queue that another handler of the group fills."""

    def __init__(self) -> None:
        super().__init__()
        self.words: asyncio.Queue[String] = asyncio.Queue()

    async def go(self, _: String) -> None:
        await self.words.get()  # stuck: Eater

    async def arrive(self, message: String) -> None:
        self.words.put_nowait(message)


class QueuePolled(Eater):
    async def go(self, _: String) -> None:
        while self.words.empty():
            await self.clock.sleep(0.05)  # stuck: QueuePolled


class Feeder(Robot):
    """Waits at a full queue that another handler of the group empties."""

    def __init__(self) -> None:
        super().__init__()
        self.plates: asyncio.Queue[String] = asyncio.Queue(1)

    async def go(self, message: String) -> None:
        await self.plates.put(message)
        await self.plates.put(message)  # stuck: Feeder

    async def arrive(self, _: String) -> None:
        self.plates.get_nowait()


class SemaphoreAcquired(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.permits = asyncio.Semaphore(0)

    async def go(self, _: String) -> None:
        await self.permits.acquire()  # stuck: SemaphoreAcquired

    async def arrive(self, _: String) -> None:
        self.permits.release()


class Notified(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.news = asyncio.Condition()
        self.has_news = False

    async def go(self, _: String) -> None:
        async with self.news:
            await self.news.wait()  # stuck: Notified

    async def arrive(self, _: String) -> None:
        async with self.news:
            self.has_news = True
            self.news.notify_all()


class NotifiedFor(Notified):
    async def go(self, _: String) -> None:
        async with self.news:
            await self.news.wait_for(lambda: self.has_news)  # stuck: NotifiedFor


class Promised(Robot):
    """Awaits a future that another handler of the group fulfils."""

    promise: asyncio.Future[None]

    async def go(self, _: String) -> None:
        self.promise = asyncio.get_running_loop().create_future()
        await self.promise  # stuck: Promised

    async def arrive(self, _: String) -> None:
        self.promise.set_result(None)


class PromisedByAnotherName(Promised):
    async def go(self, _: String) -> None:
        promise = self.promise = asyncio.get_running_loop().create_future()
        await promise  # stuck: PromisedByAnotherName


class PromisedInTime(Promised):
    async def go(self, _: String) -> None:
        self.promise = asyncio.get_running_loop().create_future()
        await asyncio.wait_for(self.promise, 60.0)  # stuck: PromisedInTime


class SleepsInAsyncio(Driver):
    async def go(self, _: String) -> None:
        while not self.there:
            await asyncio.sleep(0.05)  # stuck: SleepsInAsyncio


class CountsTurns(Driver):
    async def go(self, _: String) -> None:
        async for _turn in self.clock.every(0.1):  # stuck: CountsTurns
            if self.there:
                break


class LeavesInTheMiddle(Driver):
    async def go(self, _: String) -> None:
        while True:
            if self.there:
                return
            await self.clock.sleep(0.05)  # stuck: LeavesInTheMiddle


class PausesInAHelper(Driver):
    async def pause(self) -> None:
        await self.clock.sleep(0.05)  # stuck: PausesInAHelper

    async def go(self, _: String) -> None:
        while not self.there:
            await self.pause()


class WaitsInAHelper(Driver):
    async def wait_there(self) -> None:
        while not self.there:
            await self.clock.sleep(0.05)  # stuck: WaitsInAHelper

    async def go(self, _: String) -> None:
        await self.wait_there()


class WaitsInAFunction(Driver):
    async def go(self, _: String) -> None:
        async def wait_there() -> None:
            while not self.there:
                await self.clock.sleep(0.05)  # stuck: WaitsInAFunction

        await wait_there()


class SetByAHelper(Driver):
    def note_it(self) -> None:
        self.there = True

    async def arrive(self, _: String) -> None:
        self.note_it()


class SetByTheParentsHandler(Driver):
    """The handler is the child's, and what it does the parent's."""

    async def arrive(self, message: String) -> None:
        await super().arrive(message)


class SetInADictionary(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.state = {"phase": "driving"}

    async def go(self, _: String) -> None:
        while self.state["phase"] != "there":
            await self.clock.sleep(0.05)  # stuck: SetInADictionary

    async def arrive(self, _: String) -> None:
        self.state["phase"] = "there"


class SetBehindAProperty(Driver):
    @property
    def is_there(self) -> bool:
        return self.there

    async def go(self, _: String) -> None:
        while not self.is_there:
            await self.clock.sleep(0.05)  # stuck: SetBehindAProperty


class Docks(Robot):
    docked = False

    async def go(self, _: String) -> None:
        while not self.docked:
            await self.clock.sleep(0.05)  # stuck: Docks

    async def arrive(self, _: String) -> None:
        self.docked = True


def in_words(robot: Docks) -> str:
    """Read what is only read from outside."""
    return "docked" if robot.docked else "at sea"


class DrivesByPose(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.pose = Pose()

    def distance(self, x: float, y: float) -> float:
        return math.hypot(self.pose.x - x, self.pose.y - y)

    async def go(self, _: String) -> None:
        while self.distance(5.0, 5.0) > 0.1:
            await self.clock.sleep(0.05)  # stuck: DrivesByPose

    async def arrive(self, _: String) -> None:
        self.pose = Pose(x=5.0, y=5.0)


class NamesTheDistance(DrivesByPose):
    async def go(self, _: String) -> None:
        while (left := self.distance(5.0, 5.0)) > 0.1:
            self.log.debug("%g m to go", left)
            await self.clock.sleep(0.05)  # stuck: NamesTheDistance


class TakesThePoseApart(DrivesByPose):
    async def go(self, _: String) -> None:
        while True:
            x, y = self.pose.x, self.pose.y
            if math.hypot(x - 5.0, y - 5.0) < 0.1:
                break
            await self.clock.sleep(0.05)  # stuck: TakesThePoseApart


class CallsThreeDown(Dialler):
    async def go(self, _: String) -> None:
        await self.prepare()

    async def prepare(self) -> None:
        await self.calibrate()

    async def calibrate(self) -> None:
        await self.ask()

    async def ask(self) -> None:
        await self.ping.call(Empty.Request())  # stuck: CallsThreeDown


class CallsInTime(Dialler):
    async def go(self, _: String) -> None:
        await asyncio.wait_for(self.ping.call(Empty.Request(), timeout=9.5), 60.0)  # stuck: CallsInTime


class CallsShielded(Dialler):
    async def go(self, _: String) -> None:
        await asyncio.shield(self.ping.call(Empty.Request()))  # stuck: CallsShielded


class CallsInATask(Dialler):
    async def go(self, _: String) -> None:
        asking = asyncio.ensure_future(self.ping.call(Empty.Request()))
        await asking  # stuck: CallsInATask


class CallsTwoAtOnce(Dialler):
    async def go(self, _: String) -> None:
        await asyncio.gather(self.ping.call(Empty.Request()), self.pong.call(Empty.Request()))  # stuck: CallsTwoAtOnce


class CallsAGroup(Dialler):
    async def go(self, _: String) -> None:
        async with asyncio.TaskGroup() as calls:  # stuck: CallsAGroup
            calls.create_task(self.ping.call(Empty.Request()))
            calls.create_task(self.pong.call(Empty.Request()))


class TakesTheFirst(Dialler):
    """Both are dead."""

    async def go(self, _: String) -> None:
        calls = [asyncio.ensure_future(self.ping.call(Empty.Request())) for _ in range(2)]
        await asyncio.wait(calls, return_when=asyncio.FIRST_COMPLETED)  # stuck: TakesTheFirst


class FollowsAParameter(Dialler):
    speed = Param(1.0)
    applied = False

    @speed.on_change
    async def speed_changed(self, old: float, new: float) -> None:
        await self.ping.call(Empty.Request())  # stuck: FollowsAParameter
        self.applied = True

    async def go(self, _: String) -> None:
        self.speed = 2.0
        while not self.applied:
            await self.clock.sleep(0.1)


class TwoServices(Robot):
    """Ask each other, for ever."""

    left = Client(Empty, "left")
    right = Client(Empty, "right")

    async def go(self, _: String) -> None:
        await self.left.call(Empty.Request())

    @service(Empty, "left")
    async def on_left(self, request: Empty.Request) -> Empty.Response:
        await self.right.call(Empty.Request())
        return Empty.Response()

    @service(Empty, "right")
    async def on_right(self, request: Empty.Request) -> Empty.Response:
        await self.left.call(Empty.Request())  # stuck: TwoServices
        return Empty.Response()


class AnswersInTheGroup(Robot):
    """The service is in no group, but its answer waits for one, as it does in ROS 2."""

    echo = Client(Empty, "echo", group=Robot.motion)

    @service(Empty, "echo")
    async def on_echo(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    async def go(self, _: String) -> None:
        await self.echo.call(Empty.Request())  # stuck: AnswersInTheGroup


class TaskAndService(Dialler):
    """A service waits for a flag that is set by the task that has called it."""

    answered = False
    pung = Client(Empty, "pung")

    @service(Empty, "pung")
    async def on_pung(self, request: Empty.Request) -> Empty.Response:
        while not self.answered:
            await self.clock.sleep(0.05)
        return Empty.Response()

    @task
    async def main(self) -> None:
        await self.pung.call(Empty.Request())  # stuck: TaskAndService
        self.answered = True


class DropsNews(Waiter):
    """What sets the event is not even kept."""

    latest = Group(1, "drop_new")

    @subscription(String, "go", group=latest)
    async def go(self, _: String) -> None:
        await self.arrived.wait()  # stuck: DropsNews

    @subscription(String, "arrive", group=latest)
    async def arrive(self, _: String) -> None:
        self.arrived.set()


class Sends(Planner):
    """Sends its goal outside of the group."""

    @subscription(String, "go")
    async def go(self, _: String) -> None:
        await self.plan.send_goal(Fibonacci.Goal(order=1))


class PlansByFlag(Sends):
    planned = False

    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        while not self.planned and not goal.is_cancel_requested:
            await self.clock.sleep(0.05)  # stuck: PlansByFlag
        return Fibonacci.Result()

    async def arrive(self, _: String) -> None:
        self.planned = True


class PlansByEvent(Sends):
    def __init__(self) -> None:
        super().__init__()
        self.planning = asyncio.Event()

    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.planning.wait()  # stuck: PlansByEvent
        return Fibonacci.Result()

    @timer(0.3, group=Robot.motion)
    async def look(self) -> None:
        self.planning.set()


class PlansByCall(Sends, Dialler):
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.ping.call(Empty.Request())  # stuck: PlansByCall
        return Fibonacci.Result()


class PlansInPairs(Sends):
    """Two slots, one taken by a goal and one by a handler, and both call a service that needs a third."""

    pair = Group(2)
    pung = Client(Empty, "pung")

    @service(Empty, "pung", group=pair)
    async def on_pung(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    @action(Fibonacci, "plan", group=pair)
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.clock.sleep(0.1)
        await self.pung.call(Empty.Request())  # stuck: PlansInPairs
        return Fibonacci.Result()

    @subscription(String, "arrive", group=pair)
    async def arrive(self, _: String) -> None:
        await self.clock.sleep(0.1)
        await self.pung.call(Empty.Request())


class AwaitsItsPlan(Planner):
    async def go(self, _: String) -> None:
        async with self.plan.send(Fibonacci.Goal(order=1)) as goal:
            await goal.result()  # stuck: AwaitsItsPlan


class FollowsItsPlan(Planner):
    async def go(self, _: String) -> None:
        async with self.plan.send(Fibonacci.Goal(order=1)) as goal:
            async for _feedback in goal.feedback():  # stuck: FollowsItsPlan
                pass


class PlansWithinPlans(Robot):
    """A goal that sends another to its own action, which takes one after the other."""

    plan = ActionClient(Fibonacci, "plan")

    @subscription(String, "go")
    async def go(self, _: String) -> None:
        await self.plan.send_goal(Fibonacci.Goal(order=1))

    @action(Fibonacci, "plan", policy="queue")
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        if goal.request.order:
            part = await self.plan.send_goal(Fibonacci.Goal())
            await part.result()  # stuck: PlansWithinPlans
        return Fibonacci.Result()


class AsksBeforeItAccepts(Dialler):
    plan = ActionClient(Fibonacci, "plan")

    async def fits(self, goal: Fibonacci.Goal) -> bool:
        await self.ping.call(Empty.Request())  # stuck: AsksBeforeItAccepts
        return True

    @action(Fibonacci, "plan", accept=fits)
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        return Fibonacci.Result()

    async def go(self, _: String) -> None:
        await self.plan.send_goal(Fibonacci.Goal(order=1))


class Stuck(NamedTuple):
    """A program that cannot go on, and how that is to be told."""

    program: type[Node]
    wanted: str
    blocked: str
    """The handler that cannot run."""
    holder: str
    group: str
    verdict: str
    marker: str


CALLED = "the answer of service /ping"
PLANNED = "the result of action /plan"


def stuck(
    program: type[Node],
    wanted: str = "self.there",
    blocked: str = "subscription arrive",
    holder: str = "subscription go",
    group: str = "motion",
    *,
    verdict: str = "LIKELY DEADLOCK",
    marker: str = "",
    reason: str = "",
    when: bool = True,
) -> Any:
    """A case: a program, how it is to be told, and why it is not yet, `when` that is so."""
    case = Stuck(program, wanted, blocked, holder, group, verdict, f"stuck: {marker or program.__name__}")
    return pytest.param(case, id=program.__name__, marks=[wrong(reason)] if reason and when else [])


def dead_call(program: type[Node], *expected: str, reason: str = "") -> Any:
    """The same for a call or goal, whose deadlock is certain."""
    words = expected or (CALLED, "service on_ping")
    return stuck(program, *words, verdict="DEADLOCK", reason=reason)


@pytest.mark.parametrize(
    "case",
    [
        stuck(Waiter, "self.arrived"),
        stuck(EventWithin, "self.arrived"),
        stuck(EventWaitedFor, "self.arrived"),
        stuck(EventGathered, "self.arrived"),
        stuck(EventPolled, "self.arrived"),
        stuck(EventOfTheNextMessage, "self.arrived", holder="subscription arrive"),
        stuck(DropsNews, "self.arrived", group="latest"),
        stuck(Eater, "self.words"),
        stuck(QueuePolled, "self.words"),
        stuck(Feeder, "self.plates"),
        stuck(SemaphoreAcquired, "self.permits"),
        stuck(Notified, "self.news"),
        stuck(NotifiedFor, "self.news"),
        stuck(Promised, "self.promise"),
        stuck(PromisedByAnotherName, "self.promise"),
        stuck(PromisedInTime, "self.promise"),
        stuck(Driver),
        stuck(WholeProgram, "self.at_goal", "timer look", group="default_group"),
        stuck(ProgramOfRclpys, "self.landed", "subscription on_arrive", "subscription on_go"),
        stuck(SleepsInAsyncio),
        stuck(CountsTurns),
        stuck(LeavesInTheMiddle),
        stuck(PausesInAHelper),
        stuck(WaitsInAHelper),
        stuck(WaitsInAFunction),
        stuck(SetByAHelper, marker="Driver"),
        stuck(SetByTheParentsHandler, marker="Driver"),
        stuck(SetInADictionary, "self.state"),
        stuck(SetBehindAProperty),
        stuck(Docks, "self.docked"),
        stuck(DrivesByPose, "self.pose"),
        stuck(NamesTheDistance, "self.pose"),
        stuck(TakesThePoseApart, "self.pose"),
        dead_call(CallsThreeDown),
        dead_call(CallsInTime),
        dead_call(CallsShielded),
        dead_call(CallsInATask),
        dead_call(CallsTwoAtOnce),
        dead_call(CallsAGroup),
        dead_call(TakesTheFirst),
        dead_call(AnswersInTheGroup, "the answer of service /echo", "reply echo"),
        dead_call(TwoServices, "the answer of service /left", "service on_left", "service on_right", ""),
        stuck(FollowsAParameter, CALLED, "service on_ping", "speed_changed", ""),
        stuck(TaskAndService, "the answer of service /pung", "service on_pung", "task main", ""),
        stuck(PlansByFlag, "self.planned", holder="action on_plan"),
        stuck(PlansByEvent, "self.planning", "timer look", "action on_plan"),
        dead_call(PlansByCall, CALLED, "service on_ping", "action on_plan"),
        dead_call(
            PlansInPairs,
            "the answer of service /pung",
            "service on_pung",
            "action on_plan",
            "pair",
        ),
        dead_call(AwaitsItsPlan, PLANNED, "action on_plan"),
        dead_call(FollowsItsPlan, PLANNED, "action on_plan"),
        dead_call(PlansWithinPlans, PLANNED, "action on_plan", "action on_plan", ""),
        dead_call(
            AsksBeforeItAccepts,
            CALLED,
            "service on_ping",
            "service on_plan send_goal",
            "",
        ),
    ],
)
async def test_a_program_that_cannot_go_on(graph: Graph, caplog: Caplog, case: Stuck) -> None:
    """It is told once, within a second: who holds what and waits where, for whom that cannot run."""
    graph.deadlock = "report"
    await graph.start(case.program())
    await say(graph, "/go", "/arrive", "/arrive")
    await graph.clock.advance(1.0)
    text = the_report(caplog)

    lines = text.splitlines()
    assert lines[0].startswith(f"{case.verdict}: ")
    [found] = [n for n, line in enumerate(lines) if at(case.marker) in line]
    holds = f" holds group '{case.group}' and" if case.group else ""
    assert lines[found].startswith(f"  {case.holder} of /robot{holds} waits for {case.wanted}   (")
    assert lines[found + 1].startswith("    -> ")
    assert f"{case.blocked} of /robot " in lines[found + 1]
    assert "Any one of these ends it:" in lines or case.program is TaskAndService
    await graph.clock.advance(8.0)
    assert reports(caplog) == [text]
    assert not cleared(caplog) or case.program is EventWithin


class SlotOfAnother(Waiter):
    """Comes back to its group to set what the handler waits for that has taken its place."""

    async def go(self, _: String) -> None:
        async with self.motion.released():
            await self.clock.sleep(0.2)
        self.arrived.set()

    async def arrive(self, _: String) -> None:
        await self.arrived.wait()  # stuck: SlotOfAnother


async def test_a_run_that_cannot_come_back_to_its_group(graph: Graph, caplog: Caplog) -> None:
    """It is found without anything else that waits, and so is the handler that holds its slot."""
    graph.deadlock = "report"
    await graph.start(SlotOfAnother())
    await say(graph, "/go", "/arrive")
    await graph.clock.advance(2.0)

    assert at("stuck: SlotOfAnother") in the_report(caplog)


class DistractedDriver(Driver):
    """Waits for another process, in no group, while it drives."""

    slow = Client(Empty, "slow")

    @subscription(String, "ask")
    async def ask(self, _: String) -> None:
        await self.slow.call(Empty.Request())


async def test_what_only_the_source_tells_must_have_lasted(graph: Graph, caplog: Caplog) -> None:
    """Nothing is said of a handler that has just begun to wait, whoever makes somebody look just then."""
    graph.deadlock = "report"
    await graph.start(DistractedDriver(), Sleeper())
    await say(graph, "/ask")
    await graph.clock.advance(0.2)
    await say(graph, "/go", "/arrive")
    await graph.clock.advance(0.1)
    assert reports(caplog) == []
    await graph.clock.advance(1.0)

    assert at("stuck: Driver") in the_report(caplog)


@pytest.mark.parametrize(
    ("program", "words", "says"),
    [
        (AwaitsItsPlan, "since 0.00 s", False),
        (PlansWithinPlans, "Group(None)", False),
        (PlansWithinPlans, "policy='parallel'", True),
        (EventWithin, "times out in 4.5 s", True),
        (CallsInTime, "times out in 9.", True),
    ],
)
async def test_what_a_report_says_and_what_not(
    graph: Graph, caplog: Caplog, program: type[Node], words: str, says: bool
) -> None:
    """How long it has lasted and will, and advice that helps."""
    graph.deadlock = "report"
    await graph.start(program())
    await say(graph, "/go", "/arrive")
    await graph.clock.advance(1.0)

    assert (words in the_report(caplog)) is says


# What only looks like it


def in_three_seconds(do: Callable[[], Any]) -> Node:
    """Somebody outside who does something."""
    outside = Node("outside")
    outside.create_timer(3.0, do)
    return outside


def three_seconds_from_now(clock: Clock) -> int:
    return clock.monotonic_ns() + 3_000_000_000


class SetInNoGroup(Waiter):
    @timer(3.0)
    async def look(self) -> None:
        self.arrived.set()


class SetInAnotherGroup(Waiter):
    sense = Group(1)

    @timer(3.0, group=sense)
    async def look(self) -> None:
        self.arrived.set()


class SetByATimerOfItsOwnMaking(Waiter):
    def __init__(self) -> None:
        super().__init__()
        self.create_timer(3.0, self.look)

    async def look(self) -> None:
        self.arrived.set()


class SetByALambda(Waiter):
    def __init__(self) -> None:
        super().__init__()
        self.create_timer(3.0, lambda: self.arrived.set())


class SetByALocalFunction(Waiter):
    async def on_start(self) -> None:
        async def look() -> None:
            self.arrived.set()

        self.create_timer(3.0, look)


class SetByATask(Waiter):
    @task
    async def main(self) -> None:
        await self.clock.sleep(3.0)
        self.arrived.set()


class SetByWhatItSpawned(Waiter):
    async def toil(self) -> None:
        await self.clock.sleep(3.0)
        self.arrived.set()

    async def go(self, _: String) -> None:
        self.spawn(self.toil)
        await self.arrived.wait()


class SetByATaskOfItsOwn(SetByWhatItSpawned):
    async def go(self, _: String) -> None:
        self.toiling = asyncio.ensure_future(self.toil())
        await self.arrived.wait()


class SetByACallback(Waiter):
    async def go(self, _: String) -> None:
        self.clock.call_at(three_seconds_from_now(self.clock), self.arrived.set)
        await self.arrived.wait()


class SetByALambdaOfItsOwn(Waiter):
    async def go(self, _: String) -> None:
        self.clock.call_at(three_seconds_from_now(self.clock), lambda: self.arrived.set())
        await self.arrived.wait()


class SetByAnotherName(Waiter):
    """The event has a second name, by which a timer sets it."""

    def __init__(self) -> None:
        super().__init__()
        arrived = self.arrived = asyncio.Event()
        self.create_timer(3.0, arrived.set)


class FulfilledByAnotherName(Promised):
    async def go(self, _: String) -> None:
        promise = self.promise = asyncio.get_running_loop().create_future()
        self.clock.call_at(three_seconds_from_now(self.clock), lambda: promise.set_result(None))
        await self.promise

    async def arrive(self, _: String) -> None:
        if not self.promise.done():
            self.promise.set_result(None)


class FulfilledByACallback(Promised):
    async def go(self, _: String) -> None:
        self.promise = asyncio.get_running_loop().create_future()
        self.clock.call_at(three_seconds_from_now(self.clock), partial(self.promise.set_result, None))
        await self.promise

    async def arrive(self, _: String) -> None:
        if not self.promise.done():
            self.promise.set_result(None)


class SetByAMethodGivenAway(Waiter):
    def note_it(self) -> None:
        self.arrived.set()

    async def arrive(self, _: String) -> None:
        self.note_it()

    async def on_start(self) -> None:
        self.clock.call_at(three_seconds_from_now(self.clock), self.note_it)


class SetBesideTheWait(Waiter):
    async def go(self, _: String) -> None:
        waiting = asyncio.ensure_future(self.arrived.wait())
        resting = asyncio.ensure_future(self.clock.sleep(3.0))
        await asyncio.wait([waiting, resting], return_when=asyncio.FIRST_COMPLETED)
        waiting.cancel()


class Tracker:
    """Something that is given an event."""

    def __init__(self, event: asyncio.Event, clock: Clock) -> None:
        clock.call_at(three_seconds_from_now(clock), event.set)


class SetByAnObject(Waiter):
    async def go(self, _: String) -> None:
        self.tracker = Tracker(self.arrived, self.clock)
        await self.arrived.wait()


class SetByAFollower(Waiter):
    speed = Param(0.0)

    @speed.on_change
    async def speed_changed(self, old: float, new: float) -> None:
        self.arrived.set()

    def others(self) -> Sequence[Node]:
        return [in_three_seconds(lambda: self.parameters.set({"speed": 1.0}))]


class SetByAFollowersHelper(SetByAFollower):
    def note_it(self) -> None:
        self.arrived.set()

    async def speed_changed(self, old: float, new: float) -> None:
        self.note_it()

    async def arrive(self, _: String) -> None:
        self.note_it()


class SetByACheck(Waiter):
    speed = Param(0.0)

    def note_it(self) -> None:
        self.arrived.set()

    @speed.check
    def check_speed(self, value: float) -> None:
        self.note_it()

    async def arrive(self, _: String) -> None:
        self.note_it()

    def others(self) -> Sequence[Node]:
        return [in_three_seconds(lambda: self.parameters.set({"speed": 1.0}))]


class SetByAnEvent(Waiter):
    """By an event of a subscription's, which takes no slot."""

    def note_it(self) -> None:
        self.arrived.set()

    def noticed(self, event: Any) -> None:
        self.note_it()

    @subscription(String, "words", on_event=noticed)
    async def heard(self, message: String) -> None:
        """Take no notice."""

    async def arrive(self, _: String) -> None:
        self.note_it()

    def others(self) -> Sequence[Node]:
        outside = in_three_seconds(lambda: outside.create_publisher(String, "words"))
        return [outside]


class Distracted(Robot):
    """A call that lives, in no group, makes somebody look at what its other handlers do."""

    pong = Client(Empty, "pong")

    @service(Empty, "pong")
    async def on_pong(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(2.5)
        return Empty.Response()

    @subscription(String, "arrive")
    async def arrive(self, _: String) -> None:
        await self.pong.call(Empty.Request())


class SetByWhoPushesItOut(Distracted):
    """Newer work of the group cancels what waits for it."""

    latest = Group(1, "cancel_running")

    def __init__(self) -> None:
        super().__init__()
        self.fresh = asyncio.Event()

    @subscription(String, "go", group=latest)
    async def go(self, _: String) -> None:
        await self.fresh.wait()

    @subscription(String, "words", group=latest)
    async def heard(self, _: String) -> None:
        self.fresh.set()

    def others(self) -> Sequence[Node]:
        outside = Node("outside")
        speaker = outside.create_publisher(String, "words")
        outside.create_timer(3.0, lambda: speaker.publish(String()))
        return [outside]


class SetInTheGroupItHasLeft(Distracted):
    """Nobody holds the slot that what sets it will need."""

    def __init__(self) -> None:
        super().__init__()
        self.told = asyncio.Event()

    async def go(self, _: String) -> None:
        async with self.motion.released():
            await self.told.wait()

    @subscription(String, "words", group=Robot.motion)
    async def heard(self, _: String) -> None:
        self.told.set()

    def others(self) -> Sequence[Node]:
        outside = Node("outside")
        speaker = outside.create_publisher(String, "words")
        outside.create_timer(3.0, lambda: speaker.publish(String()))
        return [outside]


class SetByWhoHasLeft(Waiter):
    """A handler of the group is under way that sets it, without a slot."""

    async def go(self, _: String) -> None:
        async with self.motion.released():
            await self.clock.sleep(3.0)
            self.arrived.set()

    async def arrive(self, _: String) -> None:
        await self.arrived.wait()


class WaitsWithoutItsSlot(Waiter):
    async def go(self, _: String) -> None:
        async with self.motion.released():
            await self.arrived.wait()

    async def arrive(self, _: String) -> None:
        await self.clock.sleep(1.5)
        self.arrived.set()


class SetWithinALargerGroup(Waiter):
    pair = Group(2)

    @subscription(String, "go", group=pair)
    async def go(self, _: String) -> None:
        await self.clock.sleep(3.0)
        self.arrived.set()

    @subscription(String, "arrive", group=pair)
    async def arrive(self, _: String) -> None:
        await self.arrived.wait()


class CallsIntoAFullPair(Robot):
    """One of the two slots that its call needs is its own, the other is somebody's who will give it back."""

    pair = Group(2)
    pung = Client(Empty, "pung")

    @service(Empty, "pung", group=pair)
    async def on_pung(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    @subscription(String, "go", group=pair)
    async def rest(self, _: String) -> None:
        await self.clock.sleep(2.5)

    @subscription(String, "arrive", group=pair)
    async def arrive(self, _: String) -> None:
        await self.pung.call(Empty.Request())


class FlagOfATask(Driver):
    async def toil(self) -> None:
        await self.clock.sleep(3.0)
        self.there = True

    async def go(self, _: String) -> None:
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(self.toil())
            while not self.there:
                await self.clock.sleep(0.1)


class FlagOfALocalHandler(Driver):
    async def on_start(self) -> None:
        async def look() -> None:
            self.there = True

        self.create_timer(3.0, look)


class FlagByAnotherName(Driver):
    @timer(3.0)
    async def look(self) -> None:
        setattr(self, "the" + "re", True)


class FlagThroughTheDictionary(Driver):
    @timer(3.0)
    async def look(self) -> None:
        self.__dict__["there"] = True


class FlagOfAPartner(Driver):
    """What watches and what sets run side by side in one handler."""

    async def drive(self) -> None:
        await self.clock.sleep(3.0)
        self.there = True

    async def watch(self) -> None:
        while not self.there:
            await self.clock.sleep(0.1)

    async def go(self, _: String) -> None:
        await asyncio.gather(self.drive(), self.watch())


def without_source(text: str) -> type[Driver]:
    """The class `Made` of a program that is nowhere in a file, as in a notebook."""
    names: dict[str, Any] = {"Driver": Driver, "timer": timer, "__name__": "notebook"}
    exec(text, names)
    made: type[Driver] = names["Made"]
    return made


FlagOfAChildWithoutSource = without_source(
    """
class Made(Driver):
    @timer(3.0)
    async def look(self):
        self.there = True
"""
)


class FlagOfAParentWithoutSource(FlagOfAChildWithoutSource):  # type: ignore[misc, valid-type]
    async def go(self, _: String) -> None:
        while not self.there:
            await self.clock.sleep(0.1)


class FlagOfAParameter(Robot):
    speed = Param(0.0)

    async def go(self, _: String) -> None:
        while not self.speed:
            await self.clock.sleep(0.1)

    async def arrive(self, _: String) -> None:
        self.speed = 1.0

    def others(self) -> Sequence[Node]:
        return [in_three_seconds(lambda: self.parameters.set({"speed": 1.0}))]


class LooksItself(Driver):
    """The loop asks a method that may find that it is there."""

    looks = 0

    def look(self) -> None:
        self.looks += 1
        self.there = self.looks > 30

    async def go(self, _: String) -> None:
        while not self.there:
            self.look()
            await self.clock.sleep(0.1)


class LooksInBetween(Waiter):
    """It never waits for long before it looks itself."""

    looks = 0

    def look(self) -> None:
        self.looks += 1
        if self.looks > 30:
            self.arrived.set()

    async def go(self, _: String) -> None:
        while not self.arrived.is_set():
            self.look()
            with suppress(TimeoutError):
                async with self.clock.timeout(0.1):
                    await self.arrived.wait()


class StepsItself(DrivesByPose):
    """The loop moves what it looks at."""

    async def step(self) -> None:
        self.pose = Pose(x=self.pose.x + 0.2, y=self.pose.y + 0.2)
        await self.clock.sleep(0.02)

    async def go(self, _: String) -> None:
        while self.distance(5.0, 5.0) > 0.1:
            await self.step()
            await self.clock.sleep(0.1)


class EndsAtATime(Driver):
    async def go(self, _: String) -> None:
        end = three_seconds_from_now(self.clock)
        while not self.there and self.clock.monotonic_ns() < end:
            await self.clock.sleep(0.1)


class EndsAtATimeByImport(Driver):
    """The clock is a function of a module, called by its own name."""

    async def go(self, _: String) -> None:
        end = monotonic_ns() + 1_000_000_000_000
        while not self.there and monotonic_ns() < end:
            await self.clock.sleep(0.1)

    def others(self) -> Sequence[Node]:
        return [in_three_seconds(self.stop_going)]

    def stop_going(self) -> None:
        for runner in self.runners:
            for run in runner.active:
                run.cancel()


class EndsAfterTurns(Driver):
    async def go(self, _: String) -> None:
        async for n in self.clock.every(0.1):
            if self.there or n >= 30:
                break


class EndsAfterTurnsCounted(Driver):
    async def go(self, _: String) -> None:
        n = 0
        while not self.there and n < 30:
            n += 1
            await self.clock.sleep(0.1)


class EndsAfterTurnsAddedUp(Driver):
    async def go(self, _: String) -> None:
        n = 0
        while not self.there and n < 30:
            n = n + 1
            await self.clock.sleep(0.1)


class EndsAfterTurnsInTwos(Driver):
    async def go(self, _: String) -> None:
        last, n = 0, 1
        while not self.there and n < 30:
            last, n = n, n + 1
            self.log.debug("after %d comes %d", last, n)
            await self.clock.sleep(0.1)


class EndsByAGlobal(Driver):
    async def go(self, _: String) -> None:
        while not self.there and not is_over:
            await self.clock.sleep(0.1)

    def others(self) -> Sequence[Node]:
        say_over(False)
        return [in_three_seconds(lambda: say_over(True))]


is_over = False


def say_over(value: bool) -> None:
    global is_over
    is_over = value


class EndsByAKeyword(Driver):
    async def until(self, *, said: list[str]) -> None:
        while not self.there and not said:
            await self.clock.sleep(0.1)

    async def go(self, _: String) -> None:
        said: list[str] = []
        self.clock.call_at(three_seconds_from_now(self.clock), lambda: said.append("end"))
        await self.until(said=said)


class EndsByAnAssertion(Driver):
    async def go(self, _: String) -> None:
        end = three_seconds_from_now(self.clock)
        with suppress(AssertionError):
            while not self.there:
                assert self.clock.monotonic_ns() < end
                await self.clock.sleep(0.1)


class EndsByAnErrorOfItsMethod(Driver):
    def hurry(self, end: int) -> None:
        if self.clock.monotonic_ns() >= end:
            raise TimeoutError

    async def go(self, _: String) -> None:
        end = three_seconds_from_now(self.clock)
        with suppress(TimeoutError):
            while not self.there:
                self.hurry(end)
                await self.clock.sleep(0.1)


class EndsByAnErrorOfAFunction(Driver):
    async def go(self, _: String) -> None:
        end = three_seconds_from_now(self.clock)
        with suppress(TimeoutError):
            while not self.there:
                hurry(self.clock, end)
                await self.clock.sleep(0.1)


def hurry(clock: Clock, end: int) -> None:
    if clock.monotonic_ns() >= end:
        raise TimeoutError


class EndsAfterAFor(Driver):
    async def go(self, _: String) -> None:
        for _turn in range(30):
            if self.there:
                break
            await self.clock.sleep(0.1)


class Stopwatch:
    """Says when its time is over."""

    def __init__(self, clock: Clock) -> None:
        self._clock, self._end = clock, three_seconds_from_now(clock)

    @property
    def is_over(self) -> bool:
        return self._clock.monotonic_ns() >= self._end


class EndsByAStopwatch(Driver):
    async def go(self, _: String) -> None:
        watch = Stopwatch(self.clock)
        while not self.there and not watch.is_over:
            await self.clock.sleep(0.1)


class EndsByAStopwatchOfItsOwn(Driver):
    async def go(self, _: String) -> None:
        self.watch = Stopwatch(self.clock)
        while not self.there and not self.watch.is_over:
            await self.clock.sleep(0.1)


class EndsByAFunction(Driver):
    async def go(self, _: String) -> None:
        watch = Stopwatch(self.clock)
        while not self.there and not has_ended(watch):
            await self.clock.sleep(0.1)


def has_ended(watch: Stopwatch) -> bool:
    return watch.is_over


class EndsWithATask(Driver):
    async def go(self, _: String) -> None:
        resting = asyncio.ensure_future(self.clock.sleep(3.0))
        while not self.there and not resting.done():
            await self.clock.sleep(0.1)


class EndsWithALocalList(Driver):
    async def go(self, _: String) -> None:
        said: list[str] = []
        self.clock.call_at(three_seconds_from_now(self.clock), lambda: said.append("end"))
        while not self.there and not said:
            await self.clock.sleep(0.1)


class EndsWithItsGenerator(Driver):
    async def three_turns(self) -> AsyncIterator[int]:
        for n in range(3):
            await self.clock.sleep(1.0)
            yield n

    async def go(self, _: String) -> None:
        async for _turn in self.three_turns():
            if self.there:
                break


class EndsWithAMessage(Driver):
    words = Subscription(String, "words")

    async def go(self, _: String) -> None:
        async for message in self.words:
            if self.there or message.data == "end":
                break

    def others(self) -> Sequence[Node]:
        outside = Node("outside")
        speaker = outside.create_publisher(String, "words")
        outside.create_timer(3.0, lambda: speaker.publish(String(data="end")))
        return [outside]


class EndsWithAGoal(Robot):
    """The state of a goal changes without anybody assigning it."""

    plan = ActionClient(Fibonacci, "plan")
    trip: Any = None

    @action(Fibonacci, "plan")
    async def on_plan(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.clock.sleep(3.0)
        return Fibonacci.Result()

    async def go(self, _: String) -> None:
        self.trip = await self.plan.send_goal(Fibonacci.Goal(order=1))
        while not self.trip.done:
            await self.clock.sleep(0.1)

    async def arrive(self, _: String) -> None:
        await self.trip.cancel()


class State:
    """Something with a field."""

    lifted = False


class EndsWithAStateGivenAway(Robot):
    def __init__(self) -> None:
        super().__init__()
        self.condition = State()

    async def go(self, _: String) -> None:
        lift_later(self.condition, self.clock)
        while not self.condition.lifted:
            await self.clock.sleep(0.1)

    async def arrive(self, _: String) -> None:
        self.condition.lifted = False


def lift_later(state: State, clock: Clock) -> None:
    def lift() -> None:
        state.lifted = True

    clock.call_at(three_seconds_from_now(clock), lift)


class Fetched(Robot):
    """Its flag is set by another node."""

    fetched = False

    async def go(self, _: String) -> None:
        while not self.fetched:
            await self.clock.sleep(0.1)

    async def arrive(self, _: String) -> None:
        self.fetched = True

    def others(self) -> Sequence[Node]:
        return [Fetcher(self)]


class Fetcher(Node):
    def __init__(self, robot: Fetched) -> None:
        super().__init__()
        self.robot = robot

    @timer(3.0)
    async def fetch(self) -> None:
        self.robot.fetched = True


class Told(Driver):
    """Its method is called by another node."""

    def tell(self) -> None:
        self.there = True

    async def arrive(self, _: String) -> None:
        self.tell()

    def others(self) -> Sequence[Node]:
        return [in_three_seconds(lambda: self.tell())]


class ToldByAnother(Told):
    def others(self) -> Sequence[Node]:
        return [Teller(self)]


class Teller(Node):
    def __init__(self, robot: Told) -> None:
        super().__init__()
        self.robot = robot

    @timer(3.0)
    async def tell_it(self) -> None:
        self.robot.tell()


class Twin(Robot):
    """Each sets the other's flag."""

    freed = False
    twin: Twin

    async def go(self, _: String) -> None:
        while not self.freed:
            await self.clock.sleep(0.1)

    async def arrive(self, _: String) -> None:
        await self.clock.sleep(1.0)
        self.twin.freed = True

    def others(self) -> Sequence[Node]:
        self.twin = Twin("twin", remap=["go:=nothing"])
        self.twin.twin = self
        return [self.twin]


class TheParentSets(Driver):
    """The parent's handler is in no group, and the child's does what it did."""

    @timer(3.0)
    async def look(self) -> None:
        self.there = True

    async def arrive(self, _: String) -> None:
        self.there = False


class TheParentSetsStill(TheParentSets):
    async def look(self) -> None:
        await super().look()


HANDED_ON = "a method that is handed on and not called counts as called then and there"
MADE = "a coroutine that is made and not awaited at once counts as a part of its maker"
RAISED = "errors that end a loop are seen only where they are raised by name"
RENAMED = "an object that has a second name is looked for by the first only"
UNREAD = "a class of which there is no source is left out, as if it did nothing"


def legal(program: type[Robot], reason: str = "") -> Any:
    return pytest.param(program, id=program.__name__, marks=[wrong(reason)] if reason else [])


@pytest.mark.parametrize(
    "program",
    [
        legal(SetInNoGroup),
        legal(SetInAnotherGroup),
        legal(SetByATimerOfItsOwnMaking),
        legal(SetByALambda),
        legal(SetByALocalFunction),
        legal(SetByATask),
        legal(SetByWhatItSpawned),
        legal(SetByATaskOfItsOwn),
        legal(SetByACallback),
        legal(SetByALambdaOfItsOwn),
        legal(SetByAnotherName),
        legal(FulfilledByAnotherName),
        legal(FulfilledByACallback),
        legal(SetByAMethodGivenAway),
        legal(SetBesideTheWait),
        legal(SetByAnObject),
        legal(SetByAFollower),
        legal(SetByAFollowersHelper),
        legal(SetByACheck),
        legal(SetByAnEvent),
        legal(SetByWhoPushesItOut),
        legal(SetByWhoHasLeft),
        legal(WaitsWithoutItsSlot),
        legal(SetInTheGroupItHasLeft),
        legal(SetWithinALargerGroup),
        legal(CallsIntoAFullPair),
        legal(FlagOfATask),
        legal(FlagOfALocalHandler),
        legal(FlagByAnotherName),
        legal(FlagThroughTheDictionary),
        legal(FlagOfAPartner),
        pytest.param(FlagOfAChildWithoutSource, id="FlagOfAChildWithoutSource"),
        legal(FlagOfAParentWithoutSource),
        legal(FlagOfAParameter),
        legal(LooksItself),
        legal(LooksInBetween),
        legal(StepsItself),
        legal(EndsAtATime),
        legal(EndsAtATimeByImport),
        legal(EndsAfterTurns),
        legal(EndsAfterTurnsCounted),
        legal(EndsAfterTurnsAddedUp),
        legal(EndsAfterTurnsInTwos),
        legal(EndsByAGlobal),
        legal(EndsByAKeyword),
        legal(EndsByAnAssertion),
        legal(EndsByAnErrorOfItsMethod),
        legal(EndsByAnErrorOfAFunction),
        legal(EndsAfterAFor),
        legal(EndsByAStopwatch),
        legal(EndsByAStopwatchOfItsOwn),
        legal(EndsByAFunction),
        legal(EndsWithATask),
        legal(EndsWithALocalList),
        legal(EndsWithItsGenerator),
        legal(EndsWithAMessage),
        legal(EndsWithAGoal),
        legal(EndsWithAStateGivenAway),
        legal(Fetched),
        legal(Told),
        legal(ToldByAnother),
        legal(Twin),
        legal(TheParentSets),
        legal(TheParentSetsStill),
    ],
)
async def test_a_program_that_goes_on(graph: Graph, caplog: Caplog, program: type[Robot]) -> None:
    """Nothing is ever said of it, though it waits for seconds while others of its group queue."""
    graph.deadlock = "report"
    robot = program()
    await graph.start(robot, *robot.others())
    await say(graph, "/go", "/arrive", "/arrive")
    for _ in range(20):
        await graph.clock.advance(0.1)
    assert any(runner.active for runner in robot.runners)
    for _ in range(30):
        await graph.clock.advance(0.1)

    assert reports(caplog) == []
    assert not any(runner.active for runner in robot.runners)
    assert "Error" not in caplog.text


class Threaded(Waiter):
    """Waits for a thread, which the test holds up."""

    is_up = False

    def __init__(self) -> None:
        super().__init__()
        self.hold = threading.Event()

    def lift(self) -> None:
        assert self.hold.wait(10.0)
        self.is_up = True

    def lift_and_tell(self) -> None:
        self.lift()
        self.context.loop.call_soon_threadsafe(self.arrived.set)


class SetByAThread(Threaded):
    async def go(self, _: String) -> None:
        threading.Thread(target=self.lift_and_tell, daemon=True).start()
        await self.arrived.wait()


class SetByWhatIsOffloaded(Threaded):
    async def go(self, _: String) -> None:
        while not self.is_up:
            await self.offload(self.lift)


class SetByWhatAsyncioOffloads(Threaded):
    async def go(self, _: String) -> None:
        while not self.is_up:
            await asyncio.to_thread(self.lift)


@pytest.mark.parametrize(
    "program",
    [legal(SetByAThread), legal(SetByWhatIsOffloaded), legal(SetByWhatAsyncioOffloads)],
)
async def test_a_program_that_waits_for_a_thread(graph: Graph, caplog: Caplog, program: type[Threaded]) -> None:
    """A thread may end any wait."""
    graph.deadlock = "report"
    robot = program()
    await graph.start(robot)
    await say(graph, "/go", "/arrive")
    try:
        await graph.clock.advance(5.0)
        assert robot.motion.running
    finally:
        robot.hold.set()
    while robot.motion.running:
        await asyncio.sleep(0.001)

    assert reports(caplog) == []


class CallsWithoutItsSlot(Dialler):
    async def go(self, _: String) -> None:
        async with self.group.released():
            await self.ping.call(Empty.Request())


@pytest.mark.parametrize("policy", ["report", "raise"])
async def test_a_call_with_the_slot_released(graph: Graph, caplog: Caplog, policy: DeadlockPolicy) -> None:
    """It is answered, and the handler comes back."""
    graph.deadlock = policy
    robot = CallsWithoutItsSlot()
    await graph.start(robot)
    await say(graph, "/go")
    await graph.clock.advance(1.0)

    assert robot.statistics()["service /ping"]["runs"] == 1
    assert robot.motion.running == 0
    assert reports(caplog) == []


@pytest.mark.parametrize(
    ("when_full", "outcome"), [("drop_new", ServerBusy), ("cancel_running", asyncio.CancelledError)]
)
@pytest.mark.parametrize("policy", ["report", "raise"])
async def test_a_call_into_its_own_group_that_does_not_queue(
    graph: Graph, caplog: Caplog, when_full: WhenFull, outcome: type[BaseException], policy: DeadlockPolicy
) -> None:
    """The call is refused, or the caller makes room for it: either way nobody is stuck."""
    graph.deadlock = policy
    outcomes = Log()

    class Cautious(Dialler):
        async def go(self, _: String) -> None:
            try:
                await self.ping.call(Empty.Request())
            except BaseException as error:
                outcomes(type(error))
                raise

    robot = Cautious(concurrency={"motion": GroupChange(when_full=when_full)})
    await graph.start(robot)
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    assert outcomes == [outcome]
    assert robot.motion.running == 0
    assert reports(caplog) == []


class GivesUp(Node):
    """Waits a second for an answer, and then does something else, in the group that the answer needs."""

    work = Group(1)
    inspect = Client(Empty, "inspect")

    @subscription(String, "go", group=work)
    async def ask(self, _: String) -> None:
        try:
            await self.inspect.call(Empty.Request(), timeout=1.0)
        except CallTimeout:
            await self.clock.sleep(3.0)

    @service(Empty, "answer", group=work)
    async def answer(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


class Inspector(Node):
    """Takes two seconds before it asks back."""

    answer = Client(Empty, "answer")

    def __init__(self) -> None:
        super().__init__()
        self.outcomes = Log()

    @service(Empty, "inspect")
    async def on_inspect(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(2.0)
        try:
            self.outcomes(await self.answer.call(Empty.Request()))
        except CallError as error:
            self.outcomes(type(error))
        return Empty.Response()


@pytest.mark.parametrize(
    "policy",
    [
        "report",
        "raise",
    ],
)
async def test_a_caller_that_has_given_up(graph: Graph, caplog: Caplog, policy: DeadlockPolicy) -> None:
    """What was called for it may call it: it waits no more, and will give its slot back."""
    graph.deadlock = policy
    inspector = Inspector()
    await graph.start(GivesUp(), inspector)
    await say(graph, "/go")
    await graph.clock.advance(6.0)

    assert inspector.outcomes == [Empty.Response()]
    assert reports(caplog) == []


class TakesTheFirstFuture(Dialler):
    """One of two is dead, and the test ends the other."""

    def __init__(self) -> None:
        super().__init__()
        self.living: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    async def go(self, _: String) -> None:
        asking: asyncio.Future[Any] = asyncio.ensure_future(self.ping.call(Empty.Request()))
        await asyncio.wait([asking, self.living], return_when=asyncio.FIRST_COMPLETED)
        asking.cancel()


class GathersAFuture(TakesTheFirstFuture):
    async def go(self, _: String) -> None:
        asking = asyncio.ensure_future(self.ping.call(Empty.Request()))
        try:
            await asyncio.gather(asking, self.living)
        finally:
            asking.cancel()


@pytest.mark.parametrize(
    "program",
    [legal(TakesTheFirstFuture), legal(GathersAFuture)],
)
async def test_what_is_about_to_go_on(graph: Graph, program: type[TakesTheFirstFuture]) -> None:
    """A wait that is over is none, though its handler has not had its turn of the loop yet."""
    graph.deadlock = "report"
    robot = program()
    await graph.start(robot)
    await say(graph, "/go")
    if program is GathersAFuture:
        robot.living.set_exception(ValueError())
    else:
        robot.living.set_result(None)
    for _ in range(5):
        picture = robot.context.waits.picture()
        assert explained(picture, deadlocked(picture)) == []
        await asyncio.sleep(0)
    assert robot.motion.running == 0
