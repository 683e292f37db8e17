"""Processes that somebody waits for and that do not answer: told once, with what may be the matter."""

from __future__ import annotations

import asyncio
import os

import pytest

from graphflow import Client, Node, service, subscription
from graphflow.deadlock.unresponsive import SILENT_AFTER, Unresponsive
from graphflow.machines.waits.wait_graph import FREE, ActivityView, Call, Condition, WaitGraph
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph
from graphflow.testing.clock import settle
from graphflow.wire import process
from graphflow.wire.liveliness import Entity, Kind
from tests.deadlock.cast import Caplog, say
from tests.deadlock.stage import Stage


def warnings(caplog: Caplog) -> list[str]:
    return [r.getMessage() for r in caplog.records if r.name == "graphflow" and r.levelname == "WARNING"]


class Tower(Node):
    node_name = "tower"

    @service(Empty, "land")
    async def on_land(self, request: Empty.Request) -> Empty.Response:
        await self.clock.sleep(100.0)
        return Empty.Response()


class Caller(Node):
    land = Client(Empty, "land")

    @subscription(String, "go")
    async def ask(self, _: String) -> None:
        await self.land.call(Empty.Request(), timeout=None)  # asks


async def test_a_process_that_does_not_answer(graph: Graph, caplog: Caplog) -> None:
    """Who waits for it is told within two seconds and a half; and that it answers again."""
    server = Tower()
    await graph.start(server, Caller("caller"))
    context = server.context
    context.session.announce(process.token(context.domain, context.session.zid))
    context._inspection.close()
    await say(graph, "/go")
    await graph.clock.advance(2.5)

    [text] = warnings(caplog)
    assert text.startswith(f"NODE UNRESPONSIVE: /tower (process {os.getpid()}) has not answered for 1.")
    assert "subscription ask of /caller waits for /land (test_unresponsive.py:" in text
    await graph.clock.advance(20.0)
    assert len(warnings(caplog)) == 1


class Scene:
    """A handler that waits, and another process, with a node or without."""

    def __init__(self, wait: Condition, service: str = "/land", node: str = "tower") -> None:
        self.stage = Stage()
        self.unresponsive = Unresponsive(self.stage)
        view = ActivityView("a", "subscription ask", "/caller", wait=wait)
        self.waits = WaitGraph({"a": view})
        if node:
            server = Entity(0, "abc", 0, 1, Kind.SERVICE, "/", node, service, "std_srvs/srv/Empty", "x")
            self.stage.cache.apply(server.token, alive=True)
        self.token = self.stage.session.announce(process.token(0, "abc"))

    async def ask(self, *answered: str, seconds: float = 0.0) -> None:
        """All are asked, some time after the last question."""
        await self.stage.clock.advance(seconds)
        self.unresponsive.compare(self.waits, set(answered))
        await settle()


LAND = Call("c", "/land")


async def test_who_answers_is_not_silent(graphflow_runner: asyncio.Runner, caplog: Caplog) -> None:
    """Nor is anybody before the first question, nor a process that nobody knows of."""
    scene = Scene(LAND)
    assert not scene.unresponsive
    await scene.ask()
    assert not scene.unresponsive
    for _ in range(3):
        await scene.ask("abc", seconds=5.0)

    assert not scene.unresponsive
    assert warnings(caplog) == []


async def test_silence_between_two_questions(graphflow_runner: asyncio.Runner, caplog: Caplog) -> None:
    """It is told when it has lasted, once; and when it is over."""
    scene = Scene(LAND)
    await scene.ask()
    await scene.ask()
    assert scene.unresponsive
    await scene.ask(seconds=SILENT_AFTER / 2)
    assert warnings(caplog) == []
    for _ in range(3):
        await scene.ask(seconds=SILENT_AFTER / 2)

    [text] = warnings(caplog)
    assert text.startswith(
        f"NODE UNRESPONSIVE: /tower (process {os.getpid()}) has not answered for 1.0 s, "
        "and subscription ask of /caller waits for /land (for 0.00 s): it is stopped, or something holds"
    )
    await scene.ask("abc")
    assert warnings(caplog)[1:] == [f"/tower (process {os.getpid()}) answers again"]
    assert not scene.unresponsive


async def test_a_silent_process_that_goes(graphflow_runner: asyncio.Runner, caplog: Caplog) -> None:
    """That is said, too; and nothing more is expected of it."""
    scene = Scene(LAND)
    for _ in range(3):
        await scene.ask(seconds=SILENT_AFTER)
    scene.token.close()
    await settle()
    await scene.ask(seconds=SILENT_AFTER)

    assert [text.endswith("has gone") for text in warnings(caplog)] == [False, True]
    assert not scene.unresponsive


@pytest.mark.parametrize(
    ("wait", "service", "is_silent"),
    [
        (LAND, "/land", True),
        (LAND, "/start", False),
        (Call("goal:01", "/turn"), "/turn/_action/send_goal", True),
        (Call("goal:01", "/turn"), "/turn", False),
        (FREE, "/land", False),
    ],
)
async def test_who_is_waited_for(
    graphflow_runner: asyncio.Runner, wait: Condition, service: str, is_silent: bool
) -> None:
    """The process of a call's server, or of a goal's; what other processes do is nobody's business."""
    scene = Scene(wait, service)
    for _ in range(2):
        await scene.ask()

    assert bool(scene.unresponsive) is is_silent


async def test_this_very_process(graphflow_runner: asyncio.Runner) -> None:
    """It need not be asked: nobody says of it that it is silent."""
    scene = Scene(LAND, node="")
    zid = scene.stage.session.zid
    here = Entity(0, zid, 0, 1, Kind.SERVICE, "/", "tower", "/land", "std_srvs/srv/Empty", "x")
    scene.stage.cache.apply(here.token, alive=True)
    scene.stage.session.announce(process.token(0, zid))
    for _ in range(2):
        await scene.ask()

    assert not scene.unresponsive
