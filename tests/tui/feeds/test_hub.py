"""The sources of a console."""

from __future__ import annotations

import pytest

from graphflow.testing import Graph
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.panes import Content
from tests.tui.nodes import Listener, Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_nodes_of_the_graph_and_of_others(graph: Graph) -> None:
    """The supervisor's nodes come first, each once, without hidden ones."""
    await graph.start(Talker(), Listener())
    async with stage(Content("help"), graph=graph, nodes=("/talker", "/ended")) as s:
        await graph.settle()
        assert s.console.hub.nodes() == ["/talker", "/ended", "/listener"]
        assert s.console.hub.graph == "lab"


def test_without_a_supervisor() -> None:
    """The domain replaces the graph's name, and there is no file."""
    hub = Hub(7, None, (), dict)
    assert hub.graph == "domain 7"
    assert hub.nodes() == []
    assert hub.plan is None
    hub.announce("nobody hears it")
