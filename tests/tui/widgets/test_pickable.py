"""The entries of pickers."""

from __future__ import annotations

import pytest

from graphflow.console.views import VIEWS
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.widgets.pickable import contents, things
from tests.tui.nodes import Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_views_and_things(graph: Graph) -> None:
    """Every view without a subject is listed, and those of each node, topic, service and action."""
    await graph.start(Talker())
    async with stage(Content("help"), graph=graph) as s:
        await graph.settle()
        found = {item.text for item in things(s.console.hub)}
        assert {
            "log /talker",
            "params /talker",
            "echo /chatter",
            "hz /chatter",
            "call /add",
            "goals /fibonacci",
        } <= found
        names = [item.text for item in contents(s.console.hub)]
        assert {name for name, form in VIEWS.items() if not form.needs_it} <= set(names)
        assert "echo" not in names
