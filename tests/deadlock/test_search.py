"""Deadlocks as they happen: what is reported, once, with the right line, and what is not.

The tests go through the table of docs/architecture.md, "What the search must tell apart", by the numbers of its rows.
"""

from __future__ import annotations

import asyncio
import itertools
import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

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
    action,
    service,
    subscription,
    timer,
)
from graphflow.deadlock import reporting
from graphflow.deadlock import search as detector
from graphflow.interface import DeadlockPolicy, GroupChange
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.rings import explained
from graphflow.machines.waits.wait_graph import joined
from graphflow.machines.waits.wait_graph_json import from_json, to_json
from graphflow.msgs import registry
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from graphflow.transport.base import Answer
from graphflow.wire import attachment, chain
from tests.cases import slow
from tests.deadlock.cast import Caplog, Sleeper, at, cleared, reports, say, the_report
from tests.flat import flat
from tests.runtime.cast import Log


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
    told = flat(text)
    assert told.startswith("DEADLOCK: timer tick of /narcissus waits for itself timer tick of /narcissus holds group")
    assert f"/mirror {at('stuck: Narcissus')}tick, for 0.25 s, times out in 7.8 s)" in told
    assert "service answer of /narcissus waits for group 'work' of /narcissus, which timer tick" in told
    assert "/narcissus: {concurrency: {answer_group: [answer]}}" in told
    await graph.clock.advance(7.0)
    assert reports(caplog) == [text]


async def test_the_same_deadlock_again_takes_a_line(graph: Graph, caplog: Caplog) -> None:
    """It was told whole when it came first."""
    graph.deadlock = "report"
    await graph.start(Narcissus())
    await graph.clock.advance(20.0)
    _, *more = reports(caplog)
    line = "DEADLOCK again ({} times so far): timer tick of /narcissus waits for itself"
    assert more == [line.format(2), line.format(3)]


async def test_the_same_fails_at_once(graph: Graph, caplog: Caplog) -> None:
    """The call ends without time passing, with the explanation, and nothing is left to report (row 1)."""
    node = Narcissus()
    await graph.start(node)
    await graph.clock.advance(1.0)

    [error] = node.outcomes
    assert isinstance(error, DeadlockError)
    told = flat(str(error))
    assert told.startswith(
        "DEADLOCK: timer tick of /narcissus waits for itself timer tick of /narcissus holds group 'work'"
    )
    assert f"waits for the response of service /mirror {at('stuck: Narcissus')}tick" in told
    assert "-> service answer of /narcissus waits for group 'work' of /narcissus, which timer tick" in told
    assert "/narcissus: {concurrency: {answer_group: [answer]}}" in told
    await graph.clock.advance(1.5)
    assert reports(caplog) == []
    assert str(node.outcomes[1]) == "DEADLOCK again (2 times so far): timer tick of /narcissus waits for itself"


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
    """All members find it, one reports it, and the others say which: no call is ended (rows 3, 6, 29)."""
    graph.deadlock = policy
    peers = ring_of(names)
    await graph.start(*peers)
    await say(graph, "/go")
    await graph.clock.advance(0.5)
    report = the_report(caplog)

    text = flat(report)
    assert text.startswith(f"DEADLOCK: {len(names)} callbacks wait for each other in a ring ")
    assert text.count(at("stuck: Peer")) == len(names)
    for peer in peers:
        mine, other = peer.full_name, peer.other.name.removesuffix("/answer")
        assert f"subscription ask of {mine} holds group 'work' and waits for the response of service {other}/a" in text
        assert f"service answer of {other} waits for group 'work' of {other}, which subscription ask" in text
    pointers = [r.getMessage() for r in caplog.records if "waits in a deadlock" in r.getMessage()]
    [reporter] = {line.partition("the log of ")[2].partition(" explains")[0] for line in pointers}
    line = at("stuck: Peer").strip("( ")
    assert sorted(pointers) == sorted(
        f"subscription ask of {peer.full_name} ({line} ask) waits in a deadlock: "
        f"the log of {reporter} explains it, and says when it is over"
        for peer in peers
        if peer.full_name != reporter
    )
    await graph.clock.advance(7.0)
    assert reports(caplog) == [report]
    assert all(peer.context.search.pulls > 1 and peer.outcomes == [] for peer in peers)


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
    head = "DEADLOCK: subscription ask of /a waits for itself"
    assert str(error) == f"{head}; explained in the log of /b"
    await graph.clock.advance(5.0)
    [whole] = [r.getMessage() for r in caplog.records if r.levelname == "ERROR"]
    line = at("stuck: Echo asks back").strip("( ").removesuffix(" in")
    assert whole.startswith(f"{head}; on_forward waited in {line}\n  subscription ask of /a holds group 'work'")
    assert at("stuck: Echo asks") in whole
    assert "-> which calls /a/answer in the end, after 1 more callback, and service answer of /a" in flat(whole)


async def test_a_service_that_calls_its_caller_back_is_reported(graph: Graph, caplog: Caplog) -> None:
    """Where nothing is raised, both lines of the chain are told (row 5)."""
    graph.deadlock = "report"
    await graph.start(Echo("a", "b"), Echo("b", "a"))
    await say(graph, "/a/go")
    await graph.clock.advance(8.0)

    text = flat(the_report(caplog))
    assert text.startswith("DEADLOCK: 2 callbacks wait for each other in a ring ")
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
    assert all(caller.context.search.pulls > 2 for caller in callers)
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


@slow
async def test_who_queues_behind_a_ring_is_a_victim(graph: Graph, caplog: Caplog) -> None:
    """It is named, and not as a part of the ring (row 16)."""
    await graph.start(*ring_of("ab"), Peer("late", "a", delay=0.1))
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    text = the_report(caplog)
    assert text.startswith("DEADLOCK: 2 callbacks wait for each other in a ring; 1 more wait")
    assert f" behind them: subscription ask of /late {at('stuck: Peer')}ask, for 0.2" in flat(text)
    assert "holds group 'work' of /late" not in text


class Latecomer(Node):
    mirror = Client(Empty, "mirror")
    many = Group(None)

    @subscription(String, "go", group=many)
    async def ask(self, _: String) -> None:
        await self.mirror.call(Empty.Request())


@slow
@pytest.mark.parametrize("before", [False, True])
async def test_who_queues_behind_a_ring_of_another_process(graph: Graph, caplog: Caplog, before: bool) -> None:
    """The report names whoever is there, and each process once who came later to it (row 16)."""
    graph.deadlock = "report"
    await graph.start(Narcissus(), Latecomer("late"))
    await graph.clock.advance(1.1)
    if before:
        await say(graph, "/go")
    await graph.clock.advance(0.9)
    await say(graph, "/go")
    await graph.clock.advance(3.0)
    await say(graph, "/go")
    await graph.clock.advance(3.0)

    text = the_report(caplog)
    assert ("  behind them: subscription ask of /late" in text) is before
    said = [m for m in (r.getMessage() for r in caplog.records) if " waits behind the deadlock of " in m]
    assert said == ["subscription ask of /late waits behind the deadlock of timer tick of /narcissus"]


async def test_a_member_that_is_cancelled_frees_the_others(graph: Graph, caplog: Caplog) -> None:
    """The report clears, the slots and queues are empty, and nothing is made of what is left (row 18)."""
    graph.deadlock = "report"
    a, b = ring_of("ab", timeout=None)
    await graph.start(a, b)
    await say(graph, "/go")
    await graph.clock.advance(1.0)
    [run] = [run for runner in core_of(a).runners for run in runner.active]
    run.cancel()
    await graph.settle()
    assert (a.outcomes, b.outcomes) == ([], ["answered"])
    await graph.clock.advance(5.0)

    assert len(reports(caplog)) == 1
    assert cleared(caplog) == ["the deadlock of subscription ask of /a and subscription ask of /b has cleared"]
    for node in (a, b):
        assert (node.work.running, node.work.waiting) == (0, ())
        assert not node.context.ledger.calls
        assert not node.context.search.reports


async def test_a_member_that_times_out_frees_the_others(graph: Graph, caplog: Caplog) -> None:
    """The report says when that will be, and that it has been (row 19)."""
    a, b = Peer("a", "b", timeout=3.0), Peer("b", "a", timeout=None)
    await graph.start(a, b)
    await say(graph, "/go")
    await graph.clock.advance(1.0)
    text = the_report(caplog)
    mine, others = flat(text).partition(" -> ")[::2]
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


@slow
async def test_churn(graph: Graph, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """Hundreds of calls that cross each other make no phantom, however often somebody looks (row 23)."""
    for module in (detector, reporting):
        monkeypatch.setattr(module, "PROBE_AFTER", 0.004)
    monkeypatch.setattr(detector, "PROBE_LONGEST", 0.005)
    a, b = Juggler("a", "b"), Juggler("b", "a")
    await graph.start(a, b)
    await say(graph, "/go")
    for _ in range(2500):
        await graph.clock.advance(0.001)

    assert (a.thrown, b.thrown) == (800, 800)
    assert min(a.context.search.pulls, b.context.search.pulls) > 200
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


@slow
async def test_a_ring_through_the_result_of_an_action(graph: Graph, caplog: Caplog) -> None:
    """It is reported, and cancelling the goal still works: that needs no slot of the user's (row 26)."""
    customer = Customer()
    await graph.start(customer, Courier())
    await say(graph, "/go")
    await graph.clock.advance(5.0)

    text = flat(the_report(caplog))
    assert text.startswith("DEADLOCK: 2 callbacks wait for each other in a ring")
    assert f"group 'motion' and waits for the result of action /order {at('stuck: Customer')}go, " in text
    assert " -> which action deliver of /courier must give" in text
    assert f"courier waits for the response of service /position {at('stuck: Courier')}deliver, " in text
    assert "service position of /customer waits for group 'motion' of /customer, which subscription go" in text
    # Not by its name: a deadlock that code beside the class is seen to end is none.
    assert await vars(customer)["sent"].cancel()
    await graph.clock.advance(1.0)

    assert customer.outcomes == [GoalCanceled]
    assert (customer.motion.running, len(cleared(caplog))) == (0, 1)
    assert len(reports(caplog)) == 1


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
    return next(run.number for runner in core_of(node).runners for run in runner.active)


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
            lambda node: chain.extended(
                b"", chain.Hop(chain.process_of(node.context.session.zid), holder_of(node), b"\2" * 16, 1)
            ),
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
    other.context.search.close()
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


@slow
async def test_a_ring_that_opens_and_closes_again(graph: Graph, caplog: Caplog) -> None:
    """One that closes again at once is told once, however often one member tries again."""
    graph.deadlock = "report"
    a = Peer("a", "b", delay=0.0, timeout=None)
    await graph.start(a, Stubborn("b", "a"))
    await say(graph, "/go")
    await graph.clock.advance(7.0)

    assert len(reports(caplog)) == 1
    assert cleared(caplog) == []


class Crew(Node):
    """Asks two others at once, or does what one of them asks for: then it asks back, after a while."""

    work = Group(1)

    def __init__(self, name: str, others: str) -> None:
        super().__init__(name)
        self.orders = [self.create_client(Empty, f"/{other}/obey") for other in others]
        self.back = self.create_client(Empty, "/answer")
        self.delay = 0.0

    @subscription(String, "~/go", group=work)
    async def ask(self, _: String) -> None:
        self.create_service(Empty, "/answer", self.answer, group=self.work)
        orders = (order.call(Empty.Request(), timeout=None) for order in self.orders)
        await asyncio.gather(*orders, return_exceptions=True)

    @service(Empty, "~/obey")
    async def obey(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(self.delay)
        return await self.back.call(Empty.Request(), timeout=None)

    async def answer(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


@slow
@pytest.mark.parametrize("delay", [0.3, 1.0, 5.0])
async def test_a_ring_that_grows_is_one_report(graph: Graph, caplog: Caplog, delay: float) -> None:
    """Who comes to it late says nothing new, though it would have reported the whole of it (row 29).

    What is left of it when another member gives up is a ring of its own.
    """
    graph.deadlock = "report"
    crew = [Crew("a", "bc"), Crew("b", "ca"), Crew("c", "ab")]
    await graph.start(*crew)
    late, other, boss = sorted(crew, key=lambda node: node.context.session.zid)
    late.delay = delay
    await say(graph, f"{boss.full_name}/go")
    await graph.clock.advance(0.3)
    text = the_report(caplog)
    await graph.clock.advance(20.0)

    assert reports(caplog) == [text]
    assert cleared(caplog) == []
    said = [m for m in (r.getMessage() for r in caplog.records) if " waits behind the deadlock of " in m]
    assert len(said) == 1
    assert said[0].startswith(f"service obey of {late.full_name} waits behind the deadlock of ")

    assert not late.context.search._reporter.foreign  # it has no part in what was reported
    [run] = [run for runner in core_of(other).runners for run in runner.active]
    run.cancel()
    await graph.clock.advance(10.0)
    _, rest = reports(caplog)
    assert rest.startswith("DEADLOCK: 2 callbacks wait for each other in a ring\n")
    assert f"service obey of {late.full_name} waits for the response of service /answer " in flat(rest)
    assert len(cleared(caplog)) == 1


async def test_what_another_has_reported(graph: Graph, caplog: Caplog) -> None:
    """Stays its own, though the first of the members would report it today: it may have been blocked then (row 29)."""
    graph.deadlock = "report"
    peers = ring_of("ab")
    await graph.start(*peers)
    await say(graph, "/go")
    await graph.clock.advance(0.3)
    whole = joined([peer.context.search.snapshot.take() for peer in peers])
    [deadlock] = explained(whole, deadlocked(whole))
    first, second = sorted((peer.context for peer in peers), key=lambda context: context.session.zid)
    first.search._reporter.report(deadlock, whole, {frozenset(deadlock.ring): second.session.zid})
    assert reports(caplog) == []
    first.search._reporter.report(deadlock, whole)
    assert len(reports(caplog)) == 1


@slow
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

    assert not asker.context.ledger.goals


class Asker(Node):
    """Asks somebody who first wants something of it, and then something else."""

    node_name = "asker"
    own = Group(1)
    plan = Client(Empty, "/planner/plan")

    @subscription(String, "/go", group=own)
    async def go(self, _: String) -> None:
        await self.plan.call(Empty.Request(), timeout=None)

    @service(Empty, "~/first", group=own)
    async def first(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    @service(Empty, "~/second", group=own)
    async def second(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


class Planner(Node):
    """Wants both."""

    node_name = "planner"
    first = Client(Empty, "/asker/first")
    second = Client(Empty, "/asker/second")

    @service(Empty, "~/plan")
    async def make(self, request: Empty.Request) -> Empty.Response:
        await self.first.call(Empty.Request(), timeout=None)
        await self.second.call(Empty.Request(), timeout=None)
        return Empty.Response()


@slow
async def test_a_ring_of_the_same_members_that_wait_for_something_else(graph: Graph, caplog: Caplog) -> None:
    """A remedy that helps with the first of two calls: the ring through the second is told, too."""
    graph.deadlock = "report"
    node = Asker()
    await graph.start(node, Planner())
    await say(graph, "/go")
    await graph.clock.advance(2.0)
    assert "waits for the response of service /asker/first" in flat(the_report(caplog))

    groups = core_of(node).groups
    for handler in ("first", "second"):
        [runner] = [r for r in core_of(node).runners if r.spec.handler == handler]
        runner.move(groups.named(f"{handler}_group"))
        await graph.clock.advance(4.0)
        assert len(reports(caplog)) == 2
    assert "waits for the response of service /asker/second" in flat(reports(caplog)[-1])
    assert cleared(caplog)
