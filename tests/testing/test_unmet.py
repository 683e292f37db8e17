"""The section of a failing test's report on unmet waits."""

from __future__ import annotations

import asyncio
import time
from pathlib import Path

import pytest

from graphflow import ActionClient, Client, LifecycleNode, Node, Publisher, service, subscription, task, timer
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from graphflow.testing.graph import TRANSIENT_LOCAL
from graphflow.testing.unmet import arrivals, misspelt_taps, unmet, unserved, unstarted


class Talker(Node):
    words = Publisher(String, "words")

    @timer(1.0)
    async def tick(self) -> None:
        self.words.publish(String(data="a"))


class Echo(Node):
    out = Publisher(String, "out")

    @subscription(String, "words")
    async def heard(self, message: String) -> None:
        self.out.publish(message)


async def test_messages_on_their_way(graph: Graph) -> None:
    """They are counted; a test that has received them gets no hint."""
    await graph.start(Echo())
    heard, words = graph.tap(String, "/out"), graph.publisher(String, "/words")
    words.publish(String(data="a"))
    assert await unmet(graph) == [
        "1 message of /out arrived after the test had ended: await graph.settle() before inspecting them"
    ]
    assert len(heard) == 1
    assert await unmet(graph) == []


async def test_messages_that_no_tap_takes(graph: Graph) -> None:
    """The node that handles them is named, with those that came as the failing test gave others a turn."""
    await graph.start(Echo())
    graph.publisher(String, "/words").publish(String(data="a"))
    before = arrivals(graph)
    await graph.settle()
    assert await unmet(graph, before) == [
        "1 message of /words arrived at /echo after the test had ended: await graph.settle() before inspecting it"
    ]
    assert await unmet(graph) == []


async def test_names_that_no_node_has(graph: Graph) -> None:
    """With the nearest name; nodes that have ended are unknown."""
    echo = Echo(namespace="/lab")
    await graph.start(echo)
    graph.tap(String, "/out")
    graph.publisher(String, "/lab/wrods")
    assert await unmet(graph) == [
        "no node publishes /out, which the test taps; did you mean '/lab/out'?",
        "no node listens to /lab/wrods, which the test publishes; did you mean '/lab/words'?",
    ]
    await graph.stop(echo)
    assert await unmet(graph) == []


async def test_a_clock_that_stands_still(graph: Graph) -> None:
    """It is reported if work waits for it and it was never advanced."""
    await graph.start(Talker())
    assert await unmet(graph) == [
        "the test's clock stood still, and something waits for time: await graph.clock.advance(1.0)"
    ]
    await graph.clock.advance(0.1)
    assert await unmet(graph) == []


async def test_a_test_that_waits_in_real_time(graph: Graph) -> None:
    """Its line is told, with the right call."""

    async def waits() -> None:
        await asyncio.sleep(2.0)

    await graph.start(Talker())
    line = waits.__code__.co_firstlineno + 1
    way = "asyncio.sleep waits in real time, and the test's clock stood still; write await graph.clock.advance(2.0)"
    assert await unmet(graph, test=waits) == [f"test_unmet.py:{line}: {way}"]


async def test_a_lifecycle_node_that_nothing_activates(graph: Graph) -> None:
    """It is named with the transitions that are left."""

    class Camera(LifecycleNode):
        image = Publisher(String, "image")

    camera = Camera()
    await graph.start(camera)
    ways = "await node.trigger_configure() and await node.trigger_activate()"
    assert await unmet(graph) == [f"/camera is unconfigured, and its handlers do not run: {ways}"]
    await camera.trigger_configure()
    way = "await node.trigger_activate()"
    assert await unmet(graph) == [f"/camera is inactive, and its handlers do not run: {way}"]
    await camera.trigger_activate()
    assert await unmet(graph) == []


async def test_more_messages_than_a_queue_holds(graph: Graph) -> None:
    """The node is named with the topic; what a tap has not taken is not."""
    await graph.start(Echo())
    words = graph.publisher(String, "/words")
    graph.tap(String, "/words", 1)
    for _ in range(12):
        words.publish(String())
    await graph.settle()
    way = "await graph.settle() after each message, or a longer depth"
    assert await unmet(graph) == [f"/echo lost 2 messages of /words: its queue holds 10; {way}"]


async def test_nodes_that_are_made_and_not_started(graph: Graph) -> None:
    """They are named by their variables in the failing test; those that have run are not."""
    started, idle = Echo(), Talker()
    await graph.start(started)
    await graph.stop(started)
    with pytest.raises(AssertionError) as caught:
        assert not started
    assert [*unstarted(graph, caught.value)] == ["idle is not started: await graph.start(idle)"]
    await graph.start(idle)


async def test_waits_in_vain(graph: Graph) -> None:
    """For services and actions that no node offers, and for real time, each with its line."""

    class Asker(Node):
        adder = Client(AddTwoInts, "add")
        goals = ActionClient(Fibonacci, "count")

        @task
        async def ask(self) -> None:
            await self.adder.wait_ready()

        @task
        async def act(self) -> None:
            await self.goals.wait_ready()

        @task
        async def sleep(self) -> None:
            await asyncio.sleep(100.0)

    await graph.start(Asker())
    await graph.clock.advance(1.0)
    line = Asker.sleep.__code__.co_firstlineno + 2
    assert await unmet(graph) == [
        f"/asker waits (test_unmet.py:{line} in sleep) for real time, but a test does not: write "
        "await self.clock.sleep(...) instead of asyncio.sleep",
        "/asker waits for /add, which no node of the test offers",
        "/asker waits for /count, which no node of the test offers",
    ]


async def test_what_came_too_late(graph: Graph) -> None:
    """A tap and a node receive later messages only; on durable topics, earlier ones, too."""
    await graph.start(Talker())
    await graph.clock.advance(3.0)
    graph.publisher(String, "/out").publish(String())
    graph.tap(String, "/words")
    graph.tap(String, "/words", TRANSIENT_LOCAL)
    graph.tap(String, "/out")
    early = graph.publisher(String, "/early")
    kept = graph.publisher(String, "/kept", TRANSIENT_LOCAL)
    for publisher in (early, early, kept):
        publisher.publish(String())
    ear = Node("ear")
    for topic in ("early", "kept", "words"):
        ear.create_subscription(String, topic, lambda _: None)
    await graph.start(ear)
    early.publish(String())
    late = [text for text in await unmet(graph) if "before" in text]
    way = "which collects later ones: move it before the code that causes them"
    assert late == [
        f"3 messages of /words arrived before graph.tap, {way}",
        f"1 message of /out arrived before graph.tap, {way}",
        "the test published 2 messages on /early before /ear listened: start the node first",
    ]


async def test_what_came_in_time(graph: Graph) -> None:
    """There is no hint."""
    graph.tap(String, "/words")
    await graph.start(Talker(), Echo())
    words = graph.publisher(String, "/words")
    words.publish(String())
    await graph.start(Echo("second"))
    await graph.clock.advance(1.0)
    assert await unmet(graph) == []


async def test_topics_that_a_silent_node_listens_to(graph: Graph) -> None:
    """They are reported if a tap is empty and there is no other explanation."""
    await graph.start(Echo())
    graph.tap(String, "/out")
    told = "/echo listens to /words, to which neither the test nor its nodes publish"
    assert await unmet(graph) == [told]
    graph.publisher(String, "/words")
    assert await unmet(graph) == []


async def test_topics_where_the_taps_are_full(graph: Graph) -> None:
    """They are no cause."""
    await graph.start(Echo(), Talker(remap=["words:=out"]))
    heard = graph.tap(String, "/out")
    await graph.clock.advance(1.0)
    assert len(heard) == 1
    assert await unmet(graph) == []


@pytest.mark.filterwarnings("ignore:no node publishes")
async def test_taps_on_misspelt_topics(graph: Graph) -> None:
    """They are told even where a test passes; a tap on a topic that simply has no publisher is not."""
    await graph.start(Talker())
    graph.tap(String, "/wrods")
    graph.tap(String, "/elsewhere")
    graph.tap(String, "/words")
    [text] = misspelt_taps(graph)
    assert "no node publishes /wrods, which the test taps; did you mean /words?" in text


class Stamper(Talker):
    @timer(1.0)
    async def tick(self) -> None:
        self.words.publish(String(data=str(time.time())))  # real


async def test_a_node_that_reads_the_real_time(graph: Graph) -> None:
    """Its line is told if nothing else is."""
    await graph.start(Stamper())
    graph.tap(String, "/words")
    await graph.clock.advance(1.0)
    [told] = await unmet(graph)
    line = next(n for n, text in enumerate(Path(__file__).read_text().splitlines(), 1) if "  # real" in text)
    assert told == f"{__file__}:{line} reads the real time, and a test moves the graph's: write self.clock.now()"


class Adder(Node):
    @service(AddTwoInts, "add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)


async def test_a_service_that_the_test_calls(graph: Graph) -> None:
    """Its name is told, with the nearest."""
    await graph.start(Adder())
    call = asyncio.create_task(graph.call(AddTwoInts, "/ad", AddTwoInts.Request()))
    await graph.settle()
    assert [*unserved(graph)] == ["the test waits for /ad, which no node of the test offers; did you mean '/add'?"]
    call.cancel()
