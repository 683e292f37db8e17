"""What waits in `on_start` for what `on_start` itself keeps out: told at once, with the way out, and only then."""

from __future__ import annotations

import asyncio

import pytest

from graphflow import ActionClient, Client, Node, ServiceUnavailable, action, service, subscription, task
from graphflow.deadlock.protocols import Unopened
from graphflow.deadlock.startup_waits import place_of, start_of, unopened
from graphflow.executor.activity import Activity
from graphflow.machines.waits.wait_graph import QueueView
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph
from graphflow.testing.clock import settle
from tests.cases import slow
from tests.deadlock.cast import Caplog, at, in_vain, reports, say, the_report
from tests.deadlock.stage import Stage
from tests.flat import flat

REMEDY = "let on_start return: move the wait in {} into a @task"


def remedy(marker: str) -> str:
    """What is advised for the line that ends with the marker."""
    return REMEDY.format(at(marker).strip("(").removesuffix(" in "))


class Base(Node):
    """Offers a service, and hears a topic."""

    node_name = "base"
    go_on = False

    @service(Empty, "~/ready")
    async def answer(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()

    @subscription(String, "/go")
    async def hear(self, _: String) -> None:
        self.go_on = True


class Other(Base):
    """Waits until the base is ready, as that waits for it."""

    base = Client(Empty, "/base/ready")

    async def on_start(self) -> None:
        await self.base.wait_ready()  # stuck: Other


class Mutual(Base):
    """Waits until the other is ready."""

    other = Client(Empty, "/other/ready")

    async def on_start(self) -> None:
        await self.other.wait_ready()  # stuck: Mutual


class Selfish(Base):
    """Calls its own service before that can answer."""

    mine = Client(Empty, "~/ready")

    async def on_start(self) -> None:
        await self.mine.call(Empty.Request())  # stuck: Selfish


class Deaf(Base):
    """Polls for a message that its handler would be given."""

    async def on_start(self) -> None:
        while not self.go_on:
            await self.clock.sleep(0.05)  # stuck: Deaf


class Asleep(Base):
    """Waits for what one of its tasks would set."""

    def __init__(self) -> None:
        super().__init__()
        self.measured = asyncio.Event()

    async def on_start(self) -> None:
        await self.measured.wait()  # stuck: Asleep

    @task
    async def measure(self) -> None:
        self.measured.set()


class Actor(Base):
    """Waits for an action of its own."""

    turn_client = ActionClient(Fibonacci, "~/turn")

    async def on_start(self) -> None:
        await self.turn_client.wait_ready()  # stuck: Actor

    @action(Fibonacci, "~/turn")
    async def turn(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        return Fibonacci.Result()


async def begin(graph: Graph, *nodes: Node) -> list[asyncio.Task[None]]:
    """Start nodes that will not be ready soon."""
    starting = [asyncio.create_task(graph.start(node)) for node in nodes]
    await graph.settle()
    await graph.clock.advance(0.6)
    return starting


async def end(*starting: asyncio.Task[None]) -> None:
    for one in starting:
        one.cancel()
    await asyncio.gather(*starting, return_exceptions=True)


async def test_a_ring_of_starts(graph: Graph, caplog: Caplog) -> None:
    """Two nodes that each wait for the other's service, which opens when its `on_start` has returned."""
    starting = await begin(graph, Mutual(), Other(name="other"))

    text = flat(the_report(caplog))
    assert text.startswith("DEADLOCK: the on_starts of 2 nodes wait for each other in a ring")
    assert f"on_start of /base waits for service /other/ready {at('stuck: Mutual')}on_start, for 0." in text
    assert "-> service answer of /other opens when on_start of /other has returned" in text
    assert f"on_start of /other waits for service /base/ready {at('stuck: Other')}on_start, for 0." in text
    assert "-> service answer of /base opens when on_start of /base has returned (back to the first)" in text
    assert remedy("stuck: Mutual") in text or remedy("stuck: Other") in text
    await end(*starting)


async def test_ones_own_service(graph: Graph, caplog: Caplog) -> None:
    """The report comes before the call gives up."""
    [starting] = await begin(graph, Selfish())

    text = flat(the_report(caplog))
    assert text.startswith(
        "DEADLOCK: on_start of /base waits for service /base/ready, which opens when on_start has returned"
    )
    assert f"{at('stuck: Selfish')}on_start, for 0." in text
    assert remedy("stuck: Selfish") in text
    await graph.clock.advance(1.0)
    with pytest.raises(ServiceUnavailable, match="opens when on_start has returned"):
        await starting


@pytest.mark.parametrize(
    ("cls", "marker", "what", "who"),
    [(Deaf, "stuck: Deaf", "self.go_on", "hear"), (Asleep, "stuck: Asleep", "self.measured", "measure")],
)
async def test_ones_own_handlers(
    graph: Graph, caplog: Caplog, cls: type[Base], marker: str, what: str, who: str
) -> None:
    """What only a handler or a task sets is not set while `on_start` waits for it."""
    starting = await begin(graph, cls())

    text = flat(the_report(caplog))
    assert text.startswith(
        f"LIKELY DEADLOCK: on_start of /base waits for {what}, "
        f"and {who}, which sets it, runs when on_start has returned"
    )
    assert remedy(marker) in text
    assert "Group(" not in text
    await end(*starting)


async def test_ones_own_action(graph: Graph, caplog: Caplog) -> None:
    """An action is called one."""
    starting = await begin(graph, Actor())

    assert "on_start of /base waits for action /base/turn, which opens when" in flat(the_report(caplog))
    await end(*starting)


@slow
async def test_starts_that_go_on(graph: Graph, caplog: Caplog) -> None:
    """A service that a third node may still offer, and one whose node is merely slow, are no deadlock."""

    class Slow(Base):
        async def on_start(self) -> None:
            await self.clock.sleep(3.0)

    starting = await begin(graph, Other(name="other"))
    await graph.clock.advance(1.0)
    starting += await begin(graph, Slow())
    await graph.clock.advance(3.0)
    await asyncio.gather(*starting)

    assert reports(caplog) == [] == in_vain(caplog)


async def test_what_on_start_sets_later(graph: Graph, caplog: Caplog) -> None:
    """A task that `on_start` has spawned may wait for what `on_start` will set."""

    class Late(Base):
        def __init__(self) -> None:
            super().__init__()
            self.opened, self.used = asyncio.Event(), asyncio.Event()

        async def work(self) -> None:
            await self.opened.wait()
            self.used.set()

        async def on_start(self) -> None:
            self.spawn(self.work)
            await self.clock.sleep(4.0)
            self.opened.set()
            await self.used.wait()

    starting = await begin(graph, Late())
    await graph.clock.advance(4.0)
    await asyncio.gather(*starting)

    assert reports(caplog) == []


async def test_what_was_waited_for_comes(graph: Graph, caplog: Caplog) -> None:
    """Once `on_start` has returned its node hears as any other."""

    class Quick(Base):
        async def on_start(self) -> None:
            await self.clock.sleep(0.1)

    node = Quick()
    await asyncio.gather(*await begin(graph, node))
    await say(graph, "/go")

    assert node.go_on
    assert reports(caplog) == []


async def test_what_on_start_keeps_out(graphflow_runner: asyncio.Runner) -> None:
    """Each needs what `on_start` holds; nothing does once that has returned."""
    actor = Stage().actor()
    actor.unopened.append(Unopened("service answer", ("/ready",)))
    assert list(unopened(actor, "a")) == []

    actor.starting = asyncio.current_task()
    start = start_of(actor, "a")
    assert start.is_start
    assert list(unopened(actor, "a")) == [
        QueueView(f"{start.id}:0", "service answer", "/robot", (start.id,), process="a", opens=("/ready",))
    ]


async def test_the_place_of_a_task(graphflow_runner: asyncio.Runner) -> None:
    """The innermost line of the user's own in which it waits; none if it has ended."""

    async def body() -> None:
        await asyncio.Event().wait()

    async def ended() -> None: ...

    run = Activity(asyncio.get_running_loop(), body(), "run", lambda _, __: None)
    asyncio.get_running_loop().call_soon(run.start)
    await settle()
    done = asyncio.create_task(ended())
    await done

    assert place_of(run) == f"(test_startup_waits.py:{body.__code__.co_firstlineno + 1} in body)"
    assert place_of(done) == ""
