"""Topics and services without a counterpart because of a wrong name or domain."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import Any

import pytest

from graphflow import Context, Node, Publisher, subscription
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.qos import Durability, Qos
from graphflow.runtime.mistakes.network.unmatched import AT_ONCE, LATE, WARN_AFTER
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from tests.runtime.cast import running_in

Caplog = pytest.LogCaptureFixture


class Turtle(Node):
    """Listens, as turtlesim does."""

    @subscription(Twist, "/turtle1/cmd_vel")
    async def move(self, message: Twist) -> None:
        """Do nothing."""


class Circle(Node):
    """Publishes without the namespace."""

    velocity = Publisher(Twist, "cmd_vel")


TOLD = (
    "nobody listens to /cmd_vel [geometry_msgs/msg/Twist]; did you mean '/turtle1/cmd_vel', to which /turtle listens?",
    "nobody publishes /turtle1/cmd_vel [geometry_msgs/msg/Twist]; did you mean '/cmd_vel', which /circle publishes?",
)


def told(caplog: Caplog) -> list[str]:
    return sorted(text for text in caplog.messages if text.startswith("nobody"))


@pytest.mark.parametrize("classes", [(Turtle, Circle), (Circle, Turtle)])
async def test_it_is_told_once_by_both(classes: tuple[Callable[[], Node], ...], graph: Graph, caplog: Caplog) -> None:
    """Some seconds after the later one has come, whichever that is."""
    for cls in classes:
        await graph.clock.advance(60.0)
        await graph.start(cls())
    await graph.clock.advance(WARN_AFTER - 0.1)
    assert told(caplog) == []
    await graph.clock.advance(0.1)
    assert sorted(told(caplog)) == sorted(TOLD)
    await graph.start(Turtle("late"))
    await graph.clock.advance(60.0)
    assert len(told(caplog)) == 3  # the new one's


async def test_a_listener_that_comes_in_time(graph: Graph, caplog: Caplog) -> None:
    """There is no warning, even after it has left again."""
    await graph.start(Turtle(), Circle())
    await graph.clock.advance(WARN_AFTER - 0.1)
    base, teleop = Node("base"), Node("teleop")
    base.create_subscription(Twist, "cmd_vel", lambda _: None)
    teleop.create_publisher(Twist, "/turtle1/cmd_vel")
    await graph.start(base, teleop)
    await graph.clock.advance(1.0)
    await graph.stop(base)
    await graph.clock.advance(60.0)
    assert told(caplog) == []


async def test_topics_that_may_have_no_listener(graph: Graph, caplog: Caplog) -> None:
    """Are those of ROS, hidden ones, latched ones, those of commands, and those without a near name."""
    await graph.start(Turtle())
    node, hidden = Node("n"), Node("_graphflow_1")
    node.create_publisher(Twist, "/velocity")
    node.create_publisher(Twist, "/_cmd_vel")
    node.create_publisher(Twist, "/cmd_vel", Qos(durability=Durability.TRANSIENT_LOCAL))
    hidden.create_publisher(Twist, "/turtle1/cmd_vl")
    await graph.start(node, hidden)
    await graph.clock.advance(60.0)
    assert [text for text in told(caplog) if text.startswith("nobody listens")] == []


async def test_a_publisher_that_was_closed(graph: Graph, caplog: Caplog) -> None:
    """It is not reported; one that is opened repeatedly is reported once."""
    node = Node("n")
    await graph.start(Turtle(), node)
    for seconds in (1.0, WARN_AFTER, WARN_AFTER):
        publisher = node.create_publisher(Twist, "/cmd_vel")
        await graph.clock.advance(seconds)
        publisher.close()
        assert len([text for text in told(caplog) if "listens to" in text]) == (seconds > 1.0)
    assert not core_of(node).context.unmatched._waiting


async def test_many_at_once(graph: Graph, caplog: Caplog, monkeypatch: pytest.MonkeyPatch) -> None:
    """They are checked in batches, and each is reported."""
    names = [f"/cmd_v{letter}" for letter in "abcdfghijkmnopq"]
    assert len(names) > AT_ONCE
    node = Node("n")
    for name in names:
        node.create_publisher(Twist, f"{name}/cmd_vel")
    looks: list[int] = []
    base = Node("base")
    for name in names:
        base.create_subscription(Twist, f"{name}/cmd_vl", lambda _: None)
    await graph.start(node, base)
    unmatched = core_of(node).context.unmatched
    look = unmatched._check_all

    def counted(due: Sequence[Any]) -> None:
        looks.append(len(due))
        look(due)

    monkeypatch.setattr(unmatched, "_check_all", counted)
    await graph.clock.advance(WARN_AFTER)
    assert looks == [AT_ONCE, len(names) - AT_ONCE]
    assert len([text for text in told(caplog) if "listens to" in text]) == len(names)


async def test_a_loop_that_was_blocked(graph: Graph, caplog: Caplog) -> None:
    """It first processes the tokens that arrived during the block."""
    await graph.start(Turtle(), Circle())
    graph.clock._elapsed_ns += int((WARN_AFTER + 2 * LATE) * 1e9)
    await graph.clock.advance(0.0)
    assert told(caplog) == []
    await graph.clock.advance(WARN_AFTER)
    assert sorted(told(caplog)) == sorted(TOLD)


async def test_a_process_that_ends(graph: Graph, caplog: Caplog) -> None:
    """It stops reporting, for existing and new endpoints."""
    await graph.start(Turtle())
    context = Context(graph.network.session(asyncio.get_running_loop()), clock=graph.clock)
    circle = Circle()
    await core_of(circle).start(context)
    context.unmatched.close()
    circle.create_publisher(Twist, "/turtle1/cmd_vl")
    await graph.clock.advance(60.0)
    assert [text for text in told(caplog) if text.startswith("nobody listens")] == []
    await core_of(circle).stop()
    await context.close()


def open_publisher(node: Node) -> None:
    node.create_publisher(Twist, "/cmd_vel")


def open_client(node: Node) -> None:
    node.create_client(AddTwoInts, "/add")


def open_action_client(node: Node) -> None:
    node.create_action_client(Fibonacci, "/fibonacci")


async def act(goal: object) -> None:
    """Carry out no goal."""


COUNTERPARTS: list[tuple[Callable[[Node], object], Callable[[Node], object]]] = [
    (open_publisher, lambda node: node.create_subscription(Twist, "/cmd_vel", lambda _: None)),
    (open_client, lambda node: node.create_service(AddTwoInts, "/add", lambda _: AddTwoInts.Response())),
    (open_action_client, lambda node: node.create_action_server(Fibonacci, "/fibonacci", act)),
]


@pytest.mark.parametrize(("opened", "there"), COUNTERPARTS)
async def test_another_domain(
    opened: Callable[[Node], object],
    there: Callable[[Node], object],
    graph: Graph,
    caplog: Caplog,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It is reported once, if the node is alone in its domain, and the counterpart is in the other."""
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "0")
    node = Node("n")
    opened(node)
    async with running_in(graph, 7, there):
        await graph.start(node)
        await graph.clock.advance(WARN_AFTER - 0.1)
        assert caplog.messages == []
        await graph.clock.advance(0.1)
        open_publisher(node)
        await graph.clock.advance(60.0)
    assert [record.getMessage() for record in caplog.records if record.name == "graphflow.node.n"] == [
        "this domain, 0, has no other nodes; domain 7 has 1: if that is yours, join it with GRAPHFLOW_DOMAIN=7"
    ]


async def test_another_domain_is_none_of_its_business(graph: Graph, caplog: Caplog) -> None:
    """Where a node has all that it needs, and where there are others with it."""
    node = Node("n")
    COUNTERPARTS[0][1](node)
    open_publisher(node)
    async with running_in(graph, 7):
        await graph.start(node)
        await graph.clock.advance(60.0)
        await graph.start(Node("other"), Circle())
        await graph.clock.advance(60.0)
    assert caplog.messages == []


async def test_a_domain_of_others(graph: Graph, caplog: Caplog) -> None:
    """It is not mentioned, since nobody there is at the other end."""
    node = Node("n")
    open_publisher(node)
    async with running_in(graph, 7, open_publisher), running_in(graph, 8, open_client):
        await graph.start(node)
        await graph.clock.advance(60.0)
    assert caplog.messages == []


async def test_a_service_taken_for_a_topic(graph: Graph, caplog: Caplog) -> None:
    """And a topic for a service: the name is right, and the kind is not."""
    server, user = Node("server"), Node("user")
    server.create_service(AddTwoInts, "add", lambda request: AddTwoInts.Response())
    server.create_publisher(Twist, "speed", 10)
    user.create_publisher(Twist, "add", 10)
    user.create_client(AddTwoInts, "speed")
    await graph.start(server, user)
    await graph.clock.advance(WARN_AFTER + 0.1)
    assert [text for text in caplog.messages if "and not a" in text] == [
        "/add is a service of /server and not a topic: call it with a client",
        "/speed is a topic of /server and not a service: use a publisher or a subscription",
    ]
