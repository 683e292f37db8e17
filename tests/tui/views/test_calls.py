"""Services: a form from the interface, the answer, the requests before."""

from __future__ import annotations

import pytest
from textual.widgets import Input

from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views.calls import Calls
from tests.tui.nodes import Talker
from tests.tui.stage import Stage, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


def line(s: Stage, name: str) -> Input:
    return next(i for i in s.view.query(Input) if i.name == name)


async def test_calling(graph: Graph) -> None:
    """Fill in, send, read; the same request as a shell command; history."""
    Calls.asked.clear()
    await graph.start(Talker())
    async with stage(Content("calls"), graph=graph, size=(110, 34)) as s:
        await s.until("/add")
        assert "get_parameters" not in s.text
        await s.press("enter")
        await s.until(lambda: bool(s.view.query("Form")))
        await s.until(lambda: s.console.focused is line(s, "a"))
        await s.type("40")
        line(s, "b").value = "2"
        await s.until("$ graphflow service call /add example_interfaces/srv/AddTwoInts '{a: 40, b: 2}'")
        line(s, "a").value = "forty"
        await s.press("ctrl+s")
        await s.until("expected")
        line(s, "a").value = "40"
        await s.press("ctrl+s")
        await s.until("sum: 42")
        assert Calls.asked["/add"] == [{"a": 40, "b": 2}]
        line(s, "a").value = "1"
        await s.press("ctrl+s")
        await s.until("sum: 3")
        await s.press("ctrl+up")
        assert line(s, "a").value == "40"
        await s.press("escape")
        await s.until("services")


async def test_a_service_by_name(graph: Graph) -> None:
    """The form opens at once; errors of the server are told."""
    await graph.start(Talker())
    async with stage(Content("calls", "/talker/get_parameters"), graph=graph, size=(110, 34)) as s:
        await s.until(lambda: bool(s.view.query("Form")))
        line(s, "names").value = "[rate]"
        await s.press("ctrl+s")
        await s.until("double_value: 2.0")
