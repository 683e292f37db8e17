"""Services: a form from the interface, the response, and earlier requests."""

from __future__ import annotations

import pytest
from textual.widgets import Input

from graphflow.testing import Graph
from graphflow.tui.panes import Content
from tests.cases import slow
from tests.tui.nodes import Talker
from tests.tui.stage import Stage, stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


def line(s: Stage, name: str) -> Input:
    return next(i for i in s.view.query(Input) if i.name == name)


async def test_calling(graph: Graph) -> None:
    """The form is filled in and sent, the response shown; the equivalent command enters the history."""
    await graph.start(Talker())
    async with stage(Content("calls"), graph=graph, size=(110, 34)) as s:
        await s.until("/add")
        assert "get_parameters" not in s.text
        await s.press("enter")
        await s.until(lambda: bool(s.view.query("Form")))
        await s.until(lambda: s.console.focused is line(s, "a"))
        await s.type("40")
        await s.press("tab")
        await s.type("2")
        await s.until("$ graphflow service call /add example_interfaces/srv/AddTwoInts\n '{a: 40, b: 2}'")
        line(s, "a").value = "forty"
        await s.press("ctrl+s")
        await s.until("expected")
        line(s, "a").value = "40"
        await s.press("ctrl+s")
        await s.until("sum: 42")
        line(s, "a").value = "1"
        await s.press("down", "enter")
        await s.until("sum: 3")
        await s.press("ctrl+up")
        await s.until("1 of 2 sent before")
        assert line(s, "a").value == "40"
        await s.press("ctrl+down", "ctrl+down")
        await s.until("the defaults")
        assert line(s, "a").value == "0"
        await s.press("escape")
        await s.until("services")


@slow
async def test_requests_of_earlier_consoles(graph: Graph) -> None:
    """Earlier requests come from the command history, typed commands included."""
    await graph.start(Talker())
    async with stage(Content("calls", "/talker/get_parameters"), Content("calls", "/add"), graph=graph) as s:
        await s.until(lambda: bool(s.view.query("Form")))
        await s.press("ctrl+up")
        await s.until("no request to /talker/get_parameters was made before")
        s.console.hub.history.add("ros2 service call /add example_interfaces/srv/AddTwoInts '{a: 5}'")
        await s.prefix("1")
        await s.until(lambda: bool(s.view.query("Form")))
        await s.press("ctrl+up")
        await s.until("1 of 1 sent before")
        assert line(s, "a").value == "5"


@slow
async def test_a_service_by_name(graph: Graph) -> None:
    """The form opens at once; errors of the server are shown."""
    await graph.start(Talker())
    async with stage(Content("calls", "/talker/get_parameters"), graph=graph, size=(110, 34)) as s:
        await s.until(lambda: bool(s.view.query("Form")))
        line(s, "names").value = "[rate]"
        await s.press("ctrl+s")
        await s.until("double_value: 2.0")
