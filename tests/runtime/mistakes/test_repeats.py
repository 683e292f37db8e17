"""Parts that a node creates repeatedly."""

from __future__ import annotations

import pytest

from graphflow import Node, timer
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.mistakes import repeats
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph


class Forgetful(Node):
    """Create a publisher and a client in each run of a timer."""

    closes = False

    @timer(1.0)
    def tick(self) -> None:
        made = self.create_publisher(String, "chatter", 10)
        self.create_timer(100.0, self.later)
        if self.closes:
            made.close()

    def later(self) -> None:
        """Do nothing."""


def told(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.message for record in caplog.records if "created last in" in record.message]


async def test_it_is_told_with_the_line(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Once for each kind and name."""
    await graph.start(Forgetful())
    await graph.clock.advance(9.5)
    assert told(caplog) == []
    await graph.clock.advance(30.0)
    first, second = told(caplog)
    assert first.startswith(f"publisher /chatter exists 10 times, created last in {__file__}:")
    assert first.endswith(": create it once, in __init__, or close the previous one first")
    assert second.startswith("timer later exists 10 times")


async def test_what_is_closed_or_made_before_the_start(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """There is no warning: a loop in `__init__` ends."""
    node = Forgetful()
    node.closes = True
    for _ in range(20):
        node.create_publisher(String, "other", 10)
    await graph.start(node)
    await graph.clock.advance(40.0)
    assert [text for text in told(caplog) if "timer" not in text] == []


class Busy(Node):
    """Makes much that is not alike."""

    async def many(self) -> None:
        for number in range(20):
            self.create_timer(100.0 + number, lambda: None)
            self.create_publisher(String, f"topic{number}", 10).close()


async def test_what_is_not_alike(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """There is no warning, and closed parts are forgotten: names may be new each time."""
    node = Busy()
    await graph.start(node)
    node.spawn(node.many)
    await graph.settle()
    assert told(caplog) == []
    assert len(core_of(node)._repeats._made) == len(core_of(node)._repeats._alike) == 20


class Made:
    """A part."""

    title = "thing"

    def __init__(self, *, is_inner: bool) -> None:
        self.is_inner = is_inner


@pytest.mark.parametrize("is_inner", [True, False])
def test_what_the_program_has_not_made(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch, is_inner: bool
) -> None:
    """Parts of parts, and those that rclpy creates in its own thread, cause no warning."""
    made = repeats.Repeats(core_of(Node("n")))
    if not is_inner:
        monkeypatch.setattr(repeats, "_place", lambda: None)
    for _ in range(2 * repeats.MANY):
        made.made(Made(is_inner=is_inner))  # type: ignore[arg-type]
    assert told(caplog) == []


def twice(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.message for record in caplog.records if "twice" in record.message]


async def test_what_is_made_twice_by_right(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Other topics, handlers and periods, closed parts, and iterated subscriptions are legal."""
    node = Node("ear")
    await graph.start(node)

    def heard(message: String) -> None: ...

    def tick() -> None: ...

    node.create_subscription(String, "a", heard).close()
    node.create_subscription(String, "a", heard)
    node.create_subscription(String, "b", heard)
    node.create_subscription(String, "a", lambda _: None)
    node.create_subscription(String, "a", None)
    node.create_subscription(String, "a", None)
    node.create_timer(1.0, tick).cancel()
    node.create_timer(1.0, tick)
    graph.tap(String, "a")
    graph.tap(String, "a")
    assert twice(caplog) == []
    node.create_subscription(String, "a", heard)
    node.create_subscription(String, "a", heard)
    [text] = twice(caplog)
    assert text.startswith(f"subscription /a calls heard twice for each message, since {__file__}:")
    assert text.endswith(" creates it again: keep one")
