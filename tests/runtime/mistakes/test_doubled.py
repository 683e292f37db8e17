"""Handlers that are declared, and registered once more."""

from __future__ import annotations

import pytest

from graphflow import Node, subscription, timer
from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph


class Listener(Node):
    """Register its declared handler again."""

    def __init__(self) -> None:
        super().__init__("listener")
        self.create_subscription(String, "chatter", self.heard, 10)
        self.create_timer(1.0, self.tick)
        self.create_subscription(String, "other", self.heard, 10)
        self.create_timer(2.0, self.tick)
        self.create_subscription(String, "chatter", self.plain, 10)
        self.create_subscription(String, "chatter", lambda _: None, 10)

    @subscription(String, "chatter")
    async def heard(self, message: String) -> None: ...

    @timer(1.0)
    async def tick(self) -> None: ...

    def plain(self, message: String) -> None: ...


async def test_both_ways_at_once(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The warning has both lines; a handler may be registered for another topic or period."""
    node = Listener()
    first, heard = Listener.__init__.__code__.co_firstlineno + 2, Listener.heard.__code__.co_firstlineno
    text = "already registers it; remove one of the two"
    assert [record.message for record in caplog.records if text in record.message] == [
        f"{__file__}:{first}: heard is called twice for each message of /chatter, since @subscription in line {heard} "
        f"{text}",
        f"{__file__}:{first + 1}: tick is called twice for each period, since @timer in line {heard + 3} {text}",
    ]
    await graph.start(node)
