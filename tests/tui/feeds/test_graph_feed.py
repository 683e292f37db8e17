"""The graph as the console's hidden node observes it."""

from __future__ import annotations

import asyncio

import pytest

from graphflow.errors import GraphflowError
from graphflow.introspect.numbers import Flow
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from graphflow.tui.feeds import graph_feed as module
from graphflow.tui.feeds.graph_feed import Live
from graphflow.tui.panes import Content
from tests.tui.nodes import Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_it_is_hidden_and_reports_are_asked_for_only_while_wanted(
    graph: Graph, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The console's node is in no list; rates come from two reports."""
    monkeypatch.setattr(module, "POLL_INTERVAL", 0.05)
    node = Talker()
    await graph.start(node)
    async with stage(Content("help"), graph=graph) as s:
        live = s.console.hub.live
        assert live is not None
        assert live.cache.nodes(hidden=False) == ["/talker"]
        live.want("numbers")
        await s.until(lambda: "/talker" in live.numbers.lags)
        for _ in range(100):
            node.chatter.publish(String(data="x"))
        live.want("numbers")
        await s.until(lambda: live.numbers.rates.get(Flow("/talker", "publisher", "/chatter"), 0) > 0)
        live.want("concurrency")
        await s.until(lambda: live.concurrency is not None)


async def test_publishers_are_made_once(graph: Graph) -> None:
    """Pressing a key again reuses the publisher."""
    await graph.start(Talker())
    async with stage(Content("help"), graph=graph) as s:
        live = s.console.hub.live
        assert live is not None
        assert live.publisher(Twist, "/a") is live.publisher(Twist, "/a")


async def test_what_takes_time_runs_in_a_thread_and_its_errors_come_back(graph: Graph) -> None:
    """Slow work runs in a thread, and its errors come back; without a graph, the error gives the reason."""
    async with stage(Content("help"), graph=graph) as s:
        live = s.console.hub.live
        assert live is not None

        def fail(_: object) -> None:
            raise GraphflowError("no")

        with pytest.raises(GraphflowError, match="no"):
            await live.ask(fail)
        assert await live.ask(lambda view: view.domain) == 0
    alone = Live(3)
    alone.trouble = "nothing is running"
    with pytest.raises(GraphflowError, match="nothing is running"):
        await alone.ask(lambda view: view.domain)
    await asyncio.wait_for(alone.close(), 1.0)
