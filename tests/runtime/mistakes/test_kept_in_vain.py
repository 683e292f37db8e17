"""Nodes that end with a message that they keep."""

from __future__ import annotations

import pytest

from graphflow import Node, Publisher, task
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import LATCHED
from graphflow.testing import Graph


class Once(Node):
    """Publishes a message that late subscriptions receive, and ends."""

    out = Publisher(String, "map_name", LATCHED)

    @task
    async def publish(self) -> None:
        """Publish and end."""
        self.out.publish(String(data="house"))
        self.shutdown()


@pytest.mark.parametrize("is_heard", [True, False])
async def test_a_message_that_nobody_has_received(
    graph: Graph, caplog: pytest.LogCaptureFixture, is_heard: bool
) -> None:
    """It is told, unless a subscription has been there."""
    if is_heard:
        graph.tap(String, "/map_name", LATCHED)
        await graph.settle()
    await graph.start(Once())
    await graph.clock.advance(0.1)
    told = [text for text in caplog.messages if "ends, and with it" in text]
    assert told == (
        [] if is_heard else ["/once ends, and with it the message that it keeps on /map_name: keep it running"]
    )
