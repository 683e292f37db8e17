"""Groups that are kept for long: said once, with what is to be done."""

from __future__ import annotations

import os

import pytest

from graphflow import Client, Group, Node, service, subscription
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.system import host_name
from graphflow.testing import Graph
from graphflow.wire import process
from tests.deadlock.cast import reports, say
from tests.flat import flat

Caplog = pytest.LogCaptureFixture


def warnings(caplog: Caplog) -> list[str]:
    """What was said that is no deadlock."""
    return [r.getMessage() for r in caplog.records if r.name == "graphflow" and r.levelname == "WARNING"]


class Drone(Node):
    """Flies for twelve seconds in the group in which it listens."""

    node_name = "drone"
    motion = Group(1)

    @subscription(String, "go", group=motion)
    async def fly(self, _: String) -> None:
        await self.clock.sleep(12.0)  # flies

    @subscription(String, "wind", 2, group=motion)
    async def hear(self, _: String) -> None:
        """Be quick."""


async def test_a_group_that_is_kept_for_long(graph: Graph, caplog: Caplog) -> None:
    """It is told after five seconds who keeps it, who waits, and what is lost; and that it is free again."""
    await graph.start(Drone())
    await say(graph, "/wind", "/go", "/wind")
    await graph.clock.advance(1.0)
    await say(graph, *["/wind"] * 4)
    await graph.clock.advance(4.0)
    assert warnings(caplog) == []
    await graph.clock.advance(0.5)
    [text] = warnings(caplog)
    head, _, rest = text.partition("\n  subscription")
    lines = rest.splitlines()
    who = f"subscription fly of /drone (test_stalls.py:{line_of('# flies')} in fly)"
    assert flat(head) == f"STALL: {who} has held group 'motion' of /drone for more than 5.0 s"
    assert lines[0] == " hear of /drone waits for it: 2 queued, 3 dropped meanwhile"
    assert "      /drone: {concurrency: {hear_group: [hear]}}" in lines

    await graph.clock.advance(10.0)
    [over] = warnings(caplog)[1:]
    assert over.startswith("group 'motion' of /drone is free again after 12.")
    assert reports(caplog) == []


def line_of(marker: str) -> int:
    with open(__file__, encoding="utf-8") as file:
        return next(number for number, line in enumerate(file, 1) if line.rstrip().endswith(marker))


async def test_own_runs_that_wait_are_no_stall(graph: Graph, caplog: Caplog) -> None:
    """A handler's runs come one after the other, as they should."""
    await graph.start(Drone())
    await say(graph, *["/go"] * 3)
    await graph.clock.advance(40.0)

    assert warnings(caplog) == []


class Hoverer(Drone):
    """Asks for the group that it keeps."""

    land = Client(Empty, "land")

    async def fly(self, _: String) -> None:
        await self.land.call(Empty.Request(), timeout=None)  # waits for itself

    @service(Empty, "land", group=Drone.motion)
    async def on_land(self, request: Empty.Request) -> Empty.Response:
        return Empty.Response()


async def test_a_deadlock_is_not_told_twice(graph: Graph, caplog: Caplog) -> None:
    """Who waits for a ring is behind a deadlock, and no stall is made of it."""
    graph.deadlock = "report"
    await graph.start(Hoverer())
    await say(graph, "/go", "/wind")
    await graph.clock.advance(20.0)

    assert len(reports(caplog)) == 1
    assert warnings(caplog) == []


@pytest.mark.parametrize("text", ["", "a/b", "@graphflow/0/proc/z/0/x/host", "@graphflow/0/other/z/0/1/host"])
def test_tokens_that_are_none(text: str) -> None:
    """What others announce is not taken for a process."""
    assert process.parse(text) is None
    assert process.parse(process.token(3, "abc")) == process.ProcessToken(
        "abc", str(os.getuid() if hasattr(os, "getuid") else 0), os.getpid(), host_name()
    )
