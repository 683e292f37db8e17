"""The base class of views, as views of other packages use it."""

from __future__ import annotations

from typing import Any

import pytest
from textual.app import ComposeResult
from textual.widgets import Static

from graphflow.errors import GraphflowError
from graphflow.msgs.sensor_msgs.msg import BatteryState
from graphflow.testing import Graph
from graphflow.tui.commands.actions import Action
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from tests.cases import slow
from tests.conftest import PROJECT
from tests.docs.test_docs import blocks
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Battery(View):
    """Counts its updates."""

    NAME = "battery"
    DOC = "how full the battery is"
    ACTIONS = (Action("charge", "charge", keys=("c",), hint=True), Action("fail", "fail", keys=("x",)))
    EVERY = 0.05
    can_focus = True
    looks = 0
    ended = False

    def compose(self) -> ComposeResult:
        yield Static("50 %")

    def look(self, now: float) -> None:
        self.looks += 1
        self.query_one(Static).update(f"{self.looks} looks")

    def do_charge(self) -> None:
        self.did("graphflow service call /charge")
        self.open("log", "/battery")

    def do_fail(self) -> None:
        async def fail() -> None:
            raise GraphflowError("empty")

        self.work(fail, group="g")

    def closed(self) -> None:
        type(self).ended = True


@slow
async def test_a_view_of_ones_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """A view is updated while it is on screen; its keys act, its errors are shown, and it is closed in the end."""
    from graphflow.tui.registry import view_class

    def chosen(name: str) -> type[View]:
        return Battery if name == "battery" else view_class(name)

    monkeypatch.setattr("graphflow.tui.app.view_class", chosen)
    async with stage(Content("battery", "main", {"unit": "V"}), Content("nodes")) as s:
        view: Any = s.view
        assert "battery main" in s.text
        assert view.content == Content("battery", "main", {"unit": "V"})
        await s.until(lambda: view.looks > 2)
        await s.until("c charge")
        await s.press("x")
        await s.until("empty")
        await s.prefix("1")
        before = view.looks
        await s.pilot.pause(0.2)
        assert view.looks == before, "nobody looks at what is not on screen"
        await s.prefix("0")
        await s.press("c")
        await s.until("$ graphflow service call /charge   (^b y copies)")
        assert [str(p.content) for p in s.console.window.panes()] == ["battery main", "log /battery"]
        await s.prefix("o")
        await s.prefix("x")
        await s.until(lambda: Battery.ended)


@slow
async def test_the_view_of_the_page(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """The example of docs/console.md waits for its topic, shows its messages, and its key acts."""
    [example] = blocks(PROJECT / "docs" / "console.md", "python")
    made: dict[str, Any] = {"__name__": "my_robot.views"}
    exec(example.text, made)
    monkeypatch.setattr("graphflow.tui.app.view_class", lambda name: made["Battery"])
    async with stage(Content("battery", "/main"), graph=graph) as s:
        await s.until("nobody publishes /main yet")
        publisher = graph.publisher(BatteryState, "/main")
        await s.until(lambda: s.view.monitor.is_open)  # type: ignore[attr-defined]
        await graph.settle()
        publisher.publish(BatteryState(percentage=0.42))
        await graph.settle()
        await s.until("/main: 42 %")
        assert "m its messages" in s.text
        await s.press("m")
        assert [str(p.content) for p in s.console.window.panes()] == ["battery /main", "echo /main"]
