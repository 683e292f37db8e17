"""The graph of one test."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow import (
    DeclarationError,
    Node,
    ParameterError,
    Publisher,
    ServiceUnavailable,
    service,
    subscription,
    task,
)
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.mistakes.errors.attribute_errors import explain
from graphflow.testing import Graph, ManualClock, Tap
from graphflow.testing.graph import TRANSIENT_LOCAL


class Adder(Node):
    """Something to call."""

    out = Publisher(String, "out")

    @service(AddTwoInts, "add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)


class Broken(Node):
    """Fails as soon as it is up."""

    @task
    async def work(self) -> None:
        raise ValueError("broken")


async def test_nodes_run_each_as_in_a_process_of_its_own(graph: Graph) -> None:
    """With sessions of their own, one clock, and each other in sight."""
    one, two = Adder("one"), Adder("two")
    await graph.start(one, two)

    assert one.context is not two.context
    assert one.context.session.zid != two.context.session.zid
    assert one.clock is two.clock is graph.clock
    assert isinstance(graph.clock, ManualClock)
    assert one.context.cache.nodes() == two.context.cache.nodes() == ["/one", "/two"]


async def test_a_tap_is_a_sequence(graph: Graph) -> None:
    """Of all messages since it was opened, with the newest as `latest`."""
    node = Adder()
    await graph.start(node)
    node.out.publish(String(data="too early"))
    heard: Tap[String] = graph.tap(String, "/out")
    assert not heard
    assert len(heard) == 0
    with pytest.raises(IndexError):
        heard.latest  # noqa: B018

    for data in "ab":
        node.out.publish(String(data=data))
    await graph.settle()

    assert heard
    assert [m.data for m in heard] == ["a", "b"]
    assert heard[0].data == "a"
    assert heard.latest == heard[-1] == String(data="b")


async def test_a_tap_may_be_opened_before_there_is_anything(graph: Graph) -> None:
    """Nodes that start later are heard from their first word."""

    class Early(Node):
        out = Publisher(String, "out")

        @task
        async def speak(self) -> None:
            self.out.publish(String(data="first"))

    heard = graph.tap(String, "/out")
    await graph.start(Early())

    assert [m.data for m in heard] == ["first"]


async def test_the_test_may_speak(graph: Graph) -> None:
    """With publishers of its own, latched ones too."""
    heard = graph.tap(String, "/in")
    graph.publisher(String, "/in").publish(String(data="x"))
    graph.publisher(String, "/map", TRANSIENT_LOCAL).publish(String(data="kept"))
    late = graph.tap(String, "/map", TRANSIENT_LOCAL)
    await graph.settle()

    assert [m.data for m in heard] == ["x"]
    assert [m.data for m in late] == ["kept"]


async def test_the_tests_own_node_is_hidden(graph: Graph) -> None:
    """Listings that leave hidden nodes out leave it out."""
    node = Adder()
    await graph.start(node)
    graph.tap(String, "/x")
    await graph.settle()

    assert node.context.cache.nodes(hidden=False) == ["/adder"]
    assert len(node.context.cache.nodes()) == 2


async def test_the_test_may_call(graph: Graph) -> None:
    """The clock need not advance if a server answers."""
    await graph.start(Adder())

    assert (await graph.call(AddTwoInts, "/add", AddTwoInts.Request(a=1, b=2))).sum == 3
    assert graph.clock.monotonic_ns() == 0


async def test_a_call_may_wait_beside_the_test(graph: Graph) -> None:
    """The test can move the clock while a call of its own is under way."""
    call = asyncio.create_task(graph.call(AddTwoInts, "/nobody", AddTwoInts.Request()))
    await graph.clock.advance(1.0)

    with pytest.raises(ServiceUnavailable):
        await call


async def test_a_stopped_node_is_gone(graph: Graph) -> None:
    """And the rest of the graph has noticed."""
    one, two = Adder("one"), Adder("two")
    await graph.start(one, two)
    await graph.stop(one)

    assert two.context.cache.nodes() == ["/two"]
    assert not one.is_running


def test_closing_stops_everything(graphflow_runner: asyncio.Runner) -> None:
    """The network is empty afterwards."""

    async def test() -> Graph:
        graph = Graph()
        await graph.start(Adder("one"), Adder("two"))
        graph.tap(String, "/x")
        await graph.close()
        return graph

    graph = graphflow_runner.run(test())

    assert not any(node.is_running for node in graph.nodes)
    assert graph.network.tokens == {}
    assert not any(graph.network.receivers.values())


@pytest.mark.parametrize("taken", [False, True])
def test_a_failed_node_fails_its_test(graphflow_runner: asyncio.Runner, taken: bool) -> None:
    """The error of a node that failed comes out of `close`, unless the test has waited for it; the rest is stopped."""
    other = Adder()

    async def test() -> None:
        graph = Graph()
        broken = Broken()
        await graph.start(broken, other)
        if taken:
            with pytest.raises(ValueError, match="broken"):
                await broken.wait_ended()
        await graph.close()

    if taken:
        graphflow_runner.run(test())
    else:
        with pytest.raises(ValueError, match="broken"):
            graphflow_runner.run(test())
    assert not other.is_running


class Taught(Node):
    """As ROS 2 teaches it: `__init__` takes no arguments."""

    def __init__(self) -> None:
        super().__init__("taught")
        self.size = self.declare_parameter("size", 1)
        self.out = self.create_publisher(String, "out")


async def test_a_node_whose_init_takes_nothing_has_parameters(graph: Graph) -> None:
    """And a name, a namespace and remaps, as in a graph file."""
    node = graph.make(Taught, "other", namespace="/left", remap=["out:=said"], size=3)
    await graph.start(node)
    assert (node.full_name, node.size) == ("/left/other", 3)
    heard = graph.tap(String, "/left/said")
    node.out.publish(String(data="hi"))
    await graph.settle()
    assert [message.data for message in heard] == ["hi"]
    assert graph.make(Taught).full_name == "/taught"


async def test_a_parameter_that_a_made_node_does_not_have(graph: Graph) -> None:
    """The error names the parameter and the node."""
    with pytest.raises(ParameterError, match="sizes"):
        await graph.start(graph.make(Taught, sizes=3))
    with pytest.raises(ParameterError, match="size"):
        graph.make(Taught, size="x")


async def test_two_nodes_of_one_name(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """They are reported, as in a running graph; a node that replaces another is not."""
    first = Node("bob")
    await graph.start(first)
    await graph.stop(first)
    await graph.start(Node("bob"))
    assert caplog.messages == []
    await graph.start(Node("bob"))
    assert [message.partition(":")[0] for message in caplog.messages] == ["two nodes are called /bob"]


async def test_a_tap_is_shown_with_its_messages(graph: Graph) -> None:
    """It equals a list of them, and an error about a missing message has the topic."""
    tap = graph.tap(String, "out")
    assert tap == []
    assert repr(tap) == "<Tap /out []>"
    with pytest.raises(IndexError, match=r"^nothing was published on /out since the tap was opened$"):
        _ = tap.latest
    graph.publisher(String, "out").publish(String(data="a"))
    await graph.settle()
    assert tap == [String(data="a")] == tap.messages
    assert tap != [String(data="b")]


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("advance", "; write await graph.clock.advance(1.0)"),
        ("publish", "; write graph.publisher(Type, topic).publish(message)"),
        ("setle", "; did you mean 'settle'?"),
    ],
)
async def test_words_that_a_graph_has_not(graph: Graph, name: str, hint: str) -> None:
    """The error has the graph's name for it."""
    with pytest.raises(AttributeError) as caught:
        getattr(graph, name)
    explain(caught.value)
    assert str(caught.value) == f"'Graph' object has no attribute {name!r}{hint}"


async def test_a_field_of_a_tap(graph: Graph) -> None:
    """Its messages have it."""
    tap: Any = graph.tap(String, "out")
    with pytest.raises(AttributeError) as caught:
        _ = tap.data
    explain(caught.value)
    assert str(caught.value).endswith(
        "a tap is a sequence of messages, which have this attribute: write .latest.data, or [0].data"
    )


async def test_the_line_of_a_test(graph: Graph) -> None:
    """An error in a call of the graph has it."""
    tap: Any = graph.tap
    with pytest.raises(DeclarationError, match=r"^\S+test_graph\.py:\d+: create_subscription needs a message class"):
        tap("out", String)


def test_a_test_without_an_event_loop(graph: Graph) -> None:
    """The error explains how to get one."""
    with pytest.raises(RuntimeError, match="write async def instead of def"):
        graph.tap(String, "out")


class Probe(Node):
    """Check each message."""

    @subscription(String, "words")
    async def heard(self, message: String) -> None:
        if message.data == "bad":
            raise ValueError(message.data)
        assert message.data == "good", message.data


async def test_an_assertion_that_fails_in_a_handler(graph: Graph) -> None:
    """It fails the test, unless the test clears it; other errors in handlers do not."""
    await graph.start(Probe())
    words = graph.publisher(String, "/words")
    for data in ("good", "bad"):
        words.publish(String(data=data))
    await graph.settle()
    graph.raise_failed()
    words.publish(String(data="other"))
    await graph.settle()
    with pytest.raises(AssertionError, match="other"):
        graph.raise_failed()
    words.publish(String(data="other"))
    await graph.settle()
    graph.failed.clear()


async def test_an_assertion_that_ends_a_node(graph: Graph) -> None:
    """Is the test's to take, as other errors that end one are."""

    class Asserts(Node):
        @task
        async def work(self) -> None:
            raise AssertionError

    class Never(Node):
        async def on_start(self) -> None:
            raise AssertionError

    node = Asserts()
    await graph.start(node)
    with pytest.raises(AssertionError):
        await node.wait_ended()
    with pytest.raises(AssertionError):
        await graph.start(Never())
    graph.raise_failed()


def test_without_an_event_loop() -> None:
    """A plain function as a test gets an error with the correct form."""
    with pytest.raises(RuntimeError, match="write async def instead of def"):
        Graph().tap(String, "/words")
