"""A node's policy for errors of its handlers."""

from __future__ import annotations

import logging
import re

import pytest

from graphflow import ErrorBudget, Node, subscription, timer
from graphflow.errors import DeadlockError, TooManyErrors
from graphflow.interface import OnError
from graphflow.msgs.std_msgs.msg import Float64
from graphflow.runtime.failures import report
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph


async def failing() -> None:
    raise ValueError("again")


async def test_a_storm_of_errors_is_not_a_storm_of_lines(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The first is logged at once, then one a second with the number of those left out."""
    node = Node("n")
    node.create_timer(0.1, failing, on_error="log")
    await graph.start(node)
    await graph.clock.advance(2.05)

    assert [r.getMessage() for r in caplog.records] == [
        "failing: ValueError: again",
        "failing (9 more before this): ValueError: again",
    ]
    assert node.is_running
    assert node.statistics()["timer failing"] == {"runs": 20, "errors": 20, "skipped": 0}


@pytest.mark.parametrize("error", [SystemExit(3), KeyboardInterrupt()])
def test_a_handler_that_ends_the_process(caplog: pytest.LogCaptureFixture, error: BaseException) -> None:
    """It is reported with its line, without a traceback."""
    with pytest.raises(type(error)) as caught:
        raise error
    report(logging.getLogger("graphflow"), "tick", caught.value)
    [record] = caplog.records
    assert record.message.startswith(f"tick: ends the process by {type(error).__name__} ({__file__}:")
    assert record.exc_info is None


async def test_an_error_budget_that_is_spent_ends_the_node(graph: Graph) -> None:
    """Twenty errors in ten seconds are borne, and one more is not."""
    node = Node("n")
    node.create_timer(0.1, failing)
    await graph.start(node)
    await graph.clock.advance(2.0)
    assert core_of(node).failure is None
    await graph.clock.advance(0.1)

    with pytest.raises(TooManyErrors, match=r"21 handler errors within 10 s, the last in failing: ValueError: aga"):
        await node.wait_ended()


class Follower(Node):
    """Reckons with a value that a message sets."""

    x: Float64 | None = None

    @subscription(Float64, "/x")
    async def heard(self, message: Float64) -> None:
        self.x = message

    @timer(0.1)
    async def follow(self) -> None:
        self.log.debug("%f", self.x.data)  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("topic", "text"),
    [
        (
            "/turtle1/x",
            "'data'; nobody publishes /x [std_msgs/msg/Float64]; did you mean '/turtle1/x', which /leader pub",
        ),
        ("/x_raw", "'data'. The node ends"),  # which may not be meant
        ("/y", "'data'; nobody publishes /x [std_msgs/msg/Float64], and nobody listens to /y of /leader: if they"),
        ("", "'data'. The node ends"),
    ],
)
async def test_a_node_that_fails_on_none(graph: Graph, topic: str, text: str) -> None:
    """Its end names the topic that was probably meant, which is told of other nodes a second later."""
    leader, follower = Node("leader"), Follower()
    if topic:
        leader.create_publisher(Float64, topic)
    await graph.start(leader, follower)
    await graph.clock.advance(2.1)
    with pytest.raises(TooManyErrors, match=re.escape(text)):
        await follower.wait_ended()


async def test_rare_errors_are_borne_for_ever(graph: Graph) -> None:
    """Errors outside the budget's period do not count."""
    node = Node("n")
    node.create_timer(0.5, failing)
    await graph.start(node)
    await graph.clock.advance(60.0)

    assert core_of(node).failure is None


@pytest.mark.parametrize(("on_error", "ends"), [("log", False), ("end", True), ("budget", True)])
async def test_a_handler_says_what_its_errors_mean(graph: Graph, on_error: OnError, ends: bool) -> None:
    """They are logged only, end the node at once, or count against the class's budget."""

    class Strict(Node):
        error_budget = ErrorBudget(0, per=1.0)

        @timer(1.0, on_error=on_error)
        async def fail(self) -> None:
            raise KeyError("lost")

    node = Strict()
    await graph.start(node)
    await graph.clock.advance(1.0)

    assert (core_of(node).failure is not None) is ends
    core_of(node).failure_taken = True


async def test_errors_of_other_kinds_are_not_hidden(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A different error of the same handler is logged, even shortly after the first."""
    errors = iter([ValueError("one"), KeyError("two"), ValueError("three")])

    async def changing() -> None:
        raise next(errors)

    node = Node("n")
    node.create_timer(0.1, changing, on_error="log")
    await graph.start(node)
    await graph.clock.advance(0.35)
    assert [r.getMessage() for r in caplog.records][:2] == ["changing: ValueError: one", "changing: KeyError: 'two'"]
    assert "three" not in caplog.text


async def test_an_error_about_a_handler_needs_no_traceback(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """It was raised by graphflow: none of the user's lines would be in it."""
    node = Node("n")
    await graph.start(node)
    core_of(node).report_error("add", TypeError("the handler returned True"))
    assert [(r.getMessage(), r.exc_info) for r in caplog.records] == [
        ("add: TypeError: the handler returned True", None)
    ]


async def test_a_deadlock_that_comes_by(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A handler that propagates it adds its line; the explanation is not repeated."""
    texts = iter(
        ["DEADLOCK: a waits for itself", "DEADLOCK: a waits for itself\n  b waits   (x.py:1 in b)\nThis ends it:"]
    )

    async def passing_on() -> None:
        raise DeadlockError(next(texts))

    node = Node("n")
    node.create_timer(1.0, passing_on, on_error="log")
    await graph.start(node)
    await graph.clock.advance(2.0)

    first, second = (r.getMessage() for r in caplog.records)
    assert re.fullmatch(r"DEADLOCK: a waits for itself; passing_on waited in test_failures\.py:\d+", first)
    assert re.fullmatch(r"DEADLOCK: a waits for itself; passing_on waited in \S+\n  b waits .*\nThis ends it:", second)
    place = first.rpartition(" ")[2]
    texts = iter([f"DEADLOCK: a waits for itself\n  b waits   ({place} in b)"])
    await graph.clock.advance(1.0)
    assert caplog.records[-1].getMessage() == f"DEADLOCK: a waits for itself\n  b waits   ({place} in b)"
