"""Forms made of interfaces: what is filled in becomes a message, and what does not fit is told by its field."""

from __future__ import annotations

import pytest
from textual.widgets import Input

from graphflow.errors import EncodeError, GraphflowError
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.tui.form import Form, form_for
from graphflow.tui.panes import Content
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_nested_fields(graph: object) -> None:
    """By their paths; only what differs from the defaults is said."""
    async with stage(Content("nodes")) as s:
        form = Form(Twist)
        await s.view.mount(form)
        lines = {str(line.name): line for line in form.query(Input)}
        assert list(lines)[:2] == ["linear.x", "linear.y"]
        assert form.values() == {}
        lines["linear.x"].value = "2"
        lines["angular.z"].value = "-1.5"
        assert form.values() == {"linear": {"x": 2.0}, "angular": {"z": -1.5}}
        assert form.message() == Twist(linear=Vector3(x=2.0), angular=Vector3(z=-1.5))
        lines["linear.y"].value = "fast"
        with pytest.raises(EncodeError, match=r"linear\.y|Vector3\.y"):
            form.message()
        form.fill({"linear": {"z": 9.0}})
        assert form.values() == {"linear": {"z": 9.0}}


async def test_nothing_to_fill_in() -> None:
    """An empty request says so."""
    async with stage(Content("nodes")) as s:
        form = Form(Empty.Request)
        await s.view.mount(form)
        assert form.message() == Empty.Request()


def test_a_type_that_is_not_known_here() -> None:
    """It is said where the form would have been."""
    with pytest.raises(GraphflowError):
        form_for("nowhere/msg/Nothing")
