"""Completion: verbs, options, live names, types and messages."""

from __future__ import annotations

import asyncio

import pytest
from textual.widgets import Input

from graphflow.console.views import VIEWS
from graphflow.testing import Graph
from graphflow.tui.commands.completion import Completer, completed, nothing_to_complete
from graphflow.tui.panes import Content
from tests.cases import sample, slow
from tests.tui.nodes import Listener, Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
@pytest.mark.parametrize(
    ("line", "whole", "choices"),
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
async def test_completing(line: str, whole: str, choices: list[str], graph: Graph) -> None:
    """A line is completed as far as it is unambiguous, with all candidates."""
    await graph.start(Talker(), Listener())
    async with stage(Content("nodes"), graph=graph, nodes=()) as s:
        await graph.settle()
        assert await Completer(s.console.hub).complete(line) == (whole, choices)


async def test_without_a_graph_verbs_are_completed_all_the_same() -> None:
    """Only names from the graph are missing."""
    async with stage(Content("nodes")) as s:
        completer = Completer(s.console.hub)
        assert await completer.complete("ps --") == ("ps --json ", ["--json"])
        assert (await completer.complete("topic echo /x"))[1] == []


async def test_views_are_completed_where_they_can_be_typed(graph: Graph) -> None:
    """Names of views are completed beside verbs, and so are their subjects."""
    await graph.start(Talker())
    async with stage(Content("topics"), graph=graph) as s:
        completer = Completer(s.console.hub, {"plot": VIEWS["plot"], "topic": VIEWS["topics"]})
        await s.until(lambda: bool(s.console.hub.live and s.console.hub.live.cache.topics(hidden=False)))
        assert await completer.complete("pl") == ("plot ", ["plot"])
        assert await completer.complete("plot /ch") == ("plot /chatter ", ["/chatter"])
        assert await completer.complete("topic l") == ("topic list ", ["list"])
        assert await completer.complete("p") == ("p", ["param", "plot", "ps"])


class Slow(Completer):
    """Completes when the test says so."""

    def __init__(self) -> None:
        self.goes_on = asyncio.Event()

    async def complete(self, line: str) -> tuple[str, list[str]]:
        await self.goes_on.wait()
        return f"{line}ho ", [f"{line}ho"]


@slow
@pytest.mark.parametrize(("typed", "expected"), [("topic ec/chatter", "topic echo /chatter"), ("top", "top")])
async def test_what_is_typed_meanwhile_is_kept(typed: str, expected: str) -> None:
    """Text typed meanwhile stays after the completion, or in its place."""
    async with stage(Content("prompt")) as s:
        line, slow = s.view.query_one(Input), Slow()
        line.value = "topic ec"
        completing = asyncio.create_task(completed(line, slow))
        await asyncio.sleep(0)
        line.value = typed
        slow.goes_on.set()
        await completing
        assert line.value == expected


def test_nothing_to_complete() -> None:
    """The message says so."""
    assert nothing_to_complete("topic zz") == "nothing here begins with 'zz'"
    assert nothing_to_complete("topic ") == "there is nothing to complete here"
