"""Forms from interfaces: input becomes a message, and faults are shown at their fields."""

from __future__ import annotations

import pytest
from textual.widgets import Input

from graphflow.errors import EncodeError, GraphflowError
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.msgs.turtlesim.srv import Spawn
from graphflow.tui.panes import Content
from graphflow.tui.widgets import form as forms
from graphflow.tui.widgets.form import Form, form_for
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
async def test_nested_fields(graph: object) -> None:
    """Fields are named by path; only differences from the defaults are kept."""
    async with stage(Content("nodes")) as s:
        form = Form(Twist)
        await s.view.mount(form)
        lines = {str(line.name): line for line in form.query(Input)}
        assert list(lines)[:2] == ["linear.x", "linear.y"]
        assert form.values() == {}
        lines["linear.x"].value = "2"
        lines["angular.z"].value = "-1.5"
        assert form.values() == {"linear": {"x": 2.0}, "angular": {"z": -1.5}}
        assert type(form.values()["linear"]["x"]) is float
        assert form.message() == Twist(linear=Vector3(x=2.0), angular=Vector3(z=-1.5))
        lines["linear.y"].value = "fast"
        with pytest.raises(EncodeError, match=r"linear\.y|Vector3\.y"):
            form.message()
        form.fill({"linear": {"z": 9.0}})
        assert form.values() == {"linear": {"z": 9.0}}


async def test_large_messages(monkeypatch: pytest.MonkeyPatch) -> None:
    """The number of lines and their depth are limited."""
    async with stage(Content("nodes")):
        monkeypatch.setattr(forms, "FIELDS", 4)
        assert [path for path, _, _ in Form(Twist)._fields] == ["linear.x", "linear.y", "linear.z", "angular.x"]
        monkeypatch.setattr(forms, "DEPTH", 0)
        assert [path for path, _, _ in Form(Twist)._fields] == ["linear", "angular"]


async def test_nothing_to_fill_in() -> None:
    """An empty request says so."""
    async with stage(Content("nodes")) as s:
        form = Form(Empty.Request)
        await s.view.mount(form)
        assert form.message() == Empty.Request()


def test_a_type_that_is_not_known_here() -> None:
    """The error is shown in place of the form."""
    with pytest.raises(GraphflowError):
        form_for("nowhere/msg/Nothing")


@slow
async def test_from_line_to_line() -> None:
    """Tab, enter and arrows cycle through the lines; an invalid value is marked, and gets the focus."""
    async with stage(Content("nodes"), size=(60, 20)) as s:
        form = Form(Spawn.Request)
        await s.view.mount(form)
        await s.until(lambda: isinstance(s.console.focused, Input))
        for text, key in (("3", "tab"), ("4", "enter"), ("1.5", "down"), ("leo", "down")):
            await s.type(text)
            await s.press(key)
        assert form.message() == Spawn.Request(x=3.0, y=4.0, theta=1.5, name="leo")
        lines = list(form.query(Input))
        assert s.console.focused is lines[0]
        await s.press("up")
        assert s.console.focused is lines[3]
        await s.press("shift+tab", "shift+tab")
        assert s.console.focused is lines[1]
        await s.type("far")
        assert lines[1].has_class("-wrong")
        await s.press("tab")
        assert "y" in form.first_fault()
        assert s.console.focused is lines[1]
        assert not lines[0].has_class("-wrong")
