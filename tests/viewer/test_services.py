"""Services in a viewer."""

from __future__ import annotations

import pytest

from graphflow import Node, service
from graphflow.msgs.std_srvs.srv import SetBool, Trigger
from graphflow.testing import Graph
from graphflow.viewer import services
from tests.viewer.cast import Robot, served, viewer

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_calls(graph: Graph) -> None:
    """Calls get their response, or the reason for its absence."""
    async with served(graph, Robot()) as lab, viewer(lab.port) as seen:
        await seen.call(1, "/power", SetBool.Request(data=True).to_bytes())
        await seen.until(lambda: 1 in seen.answers)
        assert SetBool.Response.from_bytes(seen.answers[1]) == SetBool.Response(success=True, message="on")
        await seen.call(2, "/power", SetBool.Request(data=False).to_bytes())
        await seen.until(lambda: 2 in seen.failures)
        assert "the robot cannot be switched off" in seen.failures[2]
        await seen.call(3, "/power", b"\x00")
        await seen.call(4, "/power", b"{}", b"json")
        await seen.until(lambda: {3, 4} <= {*seen.failures})
        assert seen.failures[4] == "requests must be encoded as cdr, not 'json'"


class Forger(Node):
    """Announces another type under the name of an existing service."""

    @service(Trigger, "power")
    def power(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response()


async def test_a_name_may_have_several_types(graph: Graph) -> None:
    """An announcement of another type does not hide the service."""
    await graph.start(Forger())
    async with served(graph, Robot()) as lab, viewer(lab.port) as seen:
        both = {("/power", "std_srvs/srv/SetBool"), ("/power", "std_srvs/srv/Trigger")}
        await seen.until(lambda: both <= seen.offers)


async def test_only_so_many_are_shown(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each is described to every viewer, and others may announce any number of them."""
    monkeypatch.setattr(services, "BOUND", 1)
    await graph.start(Forger())
    async with served(graph, Robot()) as lab, viewer(lab.port) as seen:
        await seen.until(lambda: seen.offers)
        assert len(lab.bridge._services._shown) + len(lab.bridge._services._pending) == 1


async def test_hidden_services(graph: Graph) -> None:
    """They are not shown."""
    robot = Robot()
    async with served(graph, robot) as lab, viewer(lab.port) as seen:
        for name in ("/a/_hidden", "/shown"):
            robot.create_service(Trigger, name, lambda _: Trigger.Response())
        await seen.until(lambda: "/shown" in seen.services)
        assert "/a/_hidden" not in seen.services
