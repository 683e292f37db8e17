"""The graph as the console's hidden node observes it."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace
from typing import cast

import pytest

from graphflow.errors import GraphflowError
from graphflow.introspect.numbers import Flow
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import Qos, Reliability
from graphflow.runtime.context import Context
from graphflow.testing import Graph
from graphflow.tui.feeds import graph_feed as module
from graphflow.tui.feeds.graph_feed import Live
from graphflow.tui.panes import Content
from graphflow.wire import process
from graphflow.wire.liveliness import Entity, Kind
from tests.cases import slow
from tests.tui.nodes import Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
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


async def test_what_others_announce_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    """Processes and answers beyond the limits are left out, and topics with too many endpoints are not compared."""
    monkeypatch.setattr(module, "PROCESSES_BOUND", 2)
    monkeypatch.setattr(module, "REPLIES_BOUND", 2)
    live = Live(0)
    for zid in "abc":
        live._process(process.token(0, zid), True)
    assert sorted(live.processes) == ["a", "b"]
    session = SimpleNamespace(ask_reports=lambda _, __, on_replies: on_replies([b"1", b"2", b"3"], True))
    live.context = cast("Context", SimpleNamespace(loop=asyncio.get_running_loop(), session=session))
    assert await live._request("numbers") == [b"1", b"2"]


async def test_a_topic_with_too_many_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """Comparing each publisher with each subscription would take long."""
    best_effort, reliable = Qos(reliability=Reliability.BEST_EFFORT), Qos(reliability=Reliability.RELIABLE)
    ends = [
        Entity(0, zid, 0, 0, kind, "/", "n", "/t", "std_msgs/msg/String", "RIHS01_00", qos)
        for zid, kind, qos in (("a", Kind.PUBLISHER, best_effort), ("b", Kind.SUBSCRIPTION, reliable))
    ]
    live = Live(0)
    monkeypatch.setattr(live, "others", lambda: iter(ends))
    assert list(live.misfits) == ["/t"]
    live.changes += 1
    monkeypatch.setattr(module, "ENDS_BOUND", 2)
    assert live.misfits == {}
