"""Completion: verbs, options, live names, types and messages."""

from __future__ import annotations

import pytest

from graphflow.testing import Graph
from graphflow.tui.completion import Completer
from graphflow.tui.panes import Content
from tests.cases import sample
from tests.tui.nodes import Listener, Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@pytest.mark.parametrize(
    ("line", "completed", "choices"),
    sample(
        [
            ("to", "topic ", ["topic"]),
            ("", "", ["param", "ps", "topic"]),
            ("p", "p", ["param", "ps"]),
            ("topic ", "topic ", ["echo", "list"]),
            ("topic l", "topic list ", ["list"]),
            ("topic list --j", "topic list --json ", ["--json"]),
            ("topic echo /ch", "topic echo /chatter ", ["/chatter"]),
            ("topic echo --once /ch", "topic echo --once /chatter ", ["/chatter"]),
            ("topic echo --field data /ch", "topic echo --field data /chatter ", ["/chatter"]),
            ("topic echo --field ", "topic echo --field ", []),
            ("topic echo /chatter ", "topic echo /chatter std_msgs/msg/String ", ["std_msgs/msg/String"]),
            ("param get /ta", "param get /talker ", ["/talker"]),
            ("param get /talker sh", "param get /talker shout ", ["shout"]),
            ("zzz", "zzz", []),
        ]
    ),
)
async def test_completing(line: str, completed: str, choices: list[str], graph: Graph) -> None:
    """As far as it is certain, and all that it may become."""
    await graph.start(Talker(), Listener())
    async with stage(Content("nodes"), graph=graph, nodes=()) as s:
        await graph.settle()
        assert await Completer(s.console.hub).complete(line) == (completed, choices)


async def test_without_a_graph_verbs_are_completed_all_the_same() -> None:
    """Only the live names are missing."""
    async with stage(Content("nodes")) as s:
        completer = Completer(s.console.hub)
        assert await completer.complete("ps --") == ("ps --json ", ["--json"])
        assert (await completer.complete("topic echo /x"))[1] == []
