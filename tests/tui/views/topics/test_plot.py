"""Curves of a topic's numbers."""

from __future__ import annotations

import pytest

from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.testing import Graph
from graphflow.tui.panes import Content
from graphflow.tui.views.topics import plot
from tests.cases import slow
from tests.tui.nodes import Talker
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@slow
async def test_fields_by_name_and_all(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """`topic.a,b` are two curves; a topic alone, all its numeric fields."""
    monkeypatch.setattr(plot, "SAMPLES_PER_SECOND", 1e9)
    node = Talker()
    await graph.start(node)
    async with stage(Content("plot", "/speed.linear.x,angular.z"), Content("plot", "/speed"), graph=graph) as s:
        await s.look()
        await graph.settle()
        for x in (0.0, 1.0, 2.0):
            node.speed.publish(Twist(linear=Vector3(x=x)))
            await graph.settle()
        await s.look()
        await s.until("━ linear.x 2 m/s")
        await s.until("━ angular.z 0 rad/s")
        assert any("\u2800" < letter <= "\u28ff" for letter in s.text), "no curve is drawn"
        await s.press("minus")
        await s.look()
        await s.until("60 s")
        await s.prefix("1")
        await s.look()
        await graph.settle()
        node.speed.publish(Twist(linear=Vector3(x=7.0)))
        await graph.settle()
        await s.look()
        await s.until(lambda: "━ angular.z 0 rad/s" in " ".join(s.text.split()))


async def test_without_colours(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without colours, each curve has a chart of its own."""
    monkeypatch.setattr(plot, "SAMPLES_PER_SECOND", 1e9)
    monkeypatch.setenv("NO_COLOR", "1")
    node = Talker()
    await graph.start(node)
    async with stage(Content("plot", "/speed.linear.x,linear.y"), graph=graph) as s:
        await s.look()
        await graph.settle()
        node.speed.publish(Twist(linear=Vector3(x=1.0)))
        await graph.settle()
        await s.until(lambda: s.text.count("┌─") == 2)
        await s.until("30 s, an axis each")
        await s.press("a")
        await s.until("without colours, each curve has an axis of its own")


async def test_what_is_kept(graph: Graph) -> None:
    """A limited number of samples per second is kept, for four times the seconds shown, which are 2 to 600."""
    async with stage(Content("plot", "/speed.linear.x"), graph=graph) as s:
        view = s.view
        assert isinstance(view, plot.Plot)
        for at in (100.0, 100.001, 100.1, 300.0):
            view._received(Twist(), at)
            if at < 200.0:
                assert [*view._curves[0].times] == ([100.0, 100.1] if at == 100.1 else [100.0])
        assert [*view._curves[0].times] == [300.0]
        for do, seconds in ((view.do_longer, 600.0), (view.do_shorter, 2.0)):
            for _ in range(12):
                do()
            assert view._seconds == seconds


async def test_a_pause_and_the_end(graph: Graph) -> None:
    """The drawing stays while paused; the topic is left when the view is closed."""
    node = Talker()
    await graph.start(node)
    async with stage(Content("plot", "/speed.linear.x"), graph=graph) as s:
        view = s.view
        assert isinstance(view, plot.Plot)
        await s.look()
        await graph.settle()
        node.speed.publish(Twist(linear=Vector3(x=1.0)))
        await graph.settle()
        await s.look()
        await s.press("space")
        view._received(Twist(linear=Vector3(x=5.0)), view._last + 1.0)
        await s.look()
        await s.until("━ linear.x 1 m/s")
        await s.press("space")
        await s.look()
        await s.until("━ linear.x 5")
        assert view._monitor is not None
        assert view._monitor.is_open
        view.closed()
        assert not view._monitor.is_open


@slow
async def test_fields_are_chosen_and_have_axes_of_their_own(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Fields are chosen one by one until escape; curves that stay keep their samples."""
    monkeypatch.setattr(plot, "SAMPLES_PER_SECOND", 1e9)
    node = Talker()
    await graph.start(node)
    async with stage(Content("plot", "/speed.linear.x"), graph=graph, size=(90, 30)) as s:
        await s.press("f")
        await s.until("no message yet")
        await s.look()
        await graph.settle()
        for x in (0.0, 1000.0, 2.0):
            node.speed.publish(Twist(linear=Vector3(x=x), angular=Vector3(z=x)))
            await graph.settle()
        await s.press("f")
        await s.until(lambda: "linear.x shown" in " ".join(s.text.split()))
        await s.type("angular.z")
        await s.press("enter")
        await s.until(lambda: "angular.z shown" in " ".join(s.text.split()))
        await s.press("escape")
        assert s.view.title == "plot /speed.linear.x,angular.z"
        node.speed.publish(Twist(linear=Vector3(x=4.0), angular=Vector3(z=0.5)))
        await graph.settle()
        await s.look()
        await s.until("━ linear.x 4 m/s  ━ angular.z 0.5 rad/s")
        for axes, charts in (("", 2), (", an axis each", 2), (", one axis", 1)):
            await s.until(f"30 s{axes}")
            await s.look()
            assert s.text.count("┌") == charts
            await s.press("a")


@slow
async def test_fields_of_one_unit_share_an_axis(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """A layout of an earlier version, with `axes: true`, gives each curve an axis of its own."""
    monkeypatch.setattr(plot, "SAMPLES_PER_SECOND", 1e9)
    node = Talker()
    await graph.start(node)
    shown = Content("plot", "/speed.linear.x,angular.z,linear.y")
    async with stage(shown, Content("plot", shown.about, {"axes": True}), graph=graph) as s:
        for window, charts in (("0", 2), ("1", 3)):
            await s.prefix(window)
            await s.look()
            await graph.settle()
            node.speed.publish(Twist(linear=Vector3(x=1.0, y=2.0), angular=Vector3(z=3.0)))
            await graph.settle()
            await s.look()
            await s.until("━ linear.y 2 m/s")
            assert s.text.count("┌") == charts


@slow
@pytest.mark.parametrize(
    ("about", "message"),
    [
        ("/speed.linear.q", "has no field 'q'"),
        ("/speed.linear", "is of type"),
        ("/nothing", "nobody publishes /nothing"),
    ],
)
async def test_what_cannot_be_drawn(graph: Graph, about: str, message: str) -> None:
    """The reason is shown in place of curves."""
    node = Talker()
    await graph.start(node)
    async with stage(Content("plot", about), graph=graph) as s:
        await s.look()
        await graph.settle()
        node.speed.publish(Twist())
        await graph.settle()
        await s.look()
        assert message in s.text
