"""Goals: those of other clients with their feedback; sent by a form, cancelled by a key."""

from __future__ import annotations

import pytest
from textual.widgets import Input

from graphflow import Node
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views import goals
from tests.cases import slow
from tests.tui.nodes import Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
async def test_a_goal_of_somebody_else(graph: Graph) -> None:
    """A goal of another client appears with its feedback, and c cancels it."""
    await graph.start(Talker())
    async with stage(Content("goals"), graph=graph) as s:
        await s.until("no goal yet")
        await graph.settle()
        client = graph.action_client(Fibonacci, "/fibonacci")
        await graph.settle()
        sent = await client.send_goal(Fibonacci.Goal(order=5))
        await graph.settle()
        await s.until("◐ executing")
        assert "sequence: [0, 1, 1]" in s.text
        await s.until("1 running")
        await s.press("c")
        await s.until("○ canceled")
        assert sent.done
        await s.press("c")
        await s.until("the goal has ended")


@slow
async def test_sending(graph: Graph) -> None:
    """The form has the goal's fields; the result is reported."""
    await graph.start(Talker())
    async with stage(Content("goals", "/fibonacci"), graph=graph) as s:
        await s.until("no goal yet")
        await s.press("n")
        await s.until(lambda: bool(s.view.query("Form")))
        await s.until(lambda: isinstance(s.console.focused, Input))
        await s.type("7")
        await s.until("$ graphflow action send_goal -f /fibonacci")
        await s.press("ctrl+s")
        await s.until("◐ executing")
        await graph.clock.advance(6.0)
        await s.until("● succeeded")
        await s.until("sequence: [0, 1, 1, 2]")
        await s.press("n")
        await s.until(lambda: bool(s.view.query("Form")))
        await s.press("ctrl+up")
        await s.until("1 of 1 sent before")
        assert next(i for i in s.view.query(Input) if i.name == "order").value == "7"


async def test_only_so_many_actions_are_watched(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each takes two subscriptions, and others may announce any number of them."""
    monkeypatch.setattr(goals, "ACTIONS_BOUND", 1)
    await graph.start(Talker())
    node = Node("second")
    await graph.start(node)
    node.create_action_client(Fibonacci, "/another")
    async with stage(Content("goals"), graph=graph) as s:
        await s.until("1 action, 0 running")
        assert s.console.hub.live is not None
        assert len(s.console.hub.live.cache.actions()) == 2
