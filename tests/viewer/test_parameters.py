"""Parameters in a viewer."""

from __future__ import annotations

import pytest

from graphflow.testing import Graph
from tests.viewer.cast import Robot, served, viewer

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_parameters(graph: Graph) -> None:
    """Parameters are read, set and followed; a refusal gives the reason."""
    robot = Robot()
    async with served(graph, robot) as lab, viewer(lab.port) as seen:
        await seen.send("getParameters", parameterNames=[], id="all")
        await seen.until(lambda: "/robot.gain" in seen.parameters)
        assert seen.parameters["/robot.title"] == "robot"
        await seen.send("setParameters", parameters=[{"name": "/robot.gain", "value": 2}], id="set")
        await seen.until(lambda: seen.parameters["/robot.gain"] == 2)
        assert robot.gain == 2.0
        await seen.send("setParameters", parameters=[{"name": "/robot.gain", "value": 9}], id="set")
        await seen.until(lambda: seen.statuses)
        assert "/robot.gain" in seen.statuses[0]
        assert robot.gain == 2.0
        await seen.send("setParameters", parameters=[{"name": "/nobody.gain", "value": 9}], id="set")
        await seen.until(lambda: len(seen.statuses) == 2)
        assert "no node /nobody has parameters" in seen.statuses[1]
        await seen.send("subscribeParameterUpdates", parameterNames=["/robot.title"])
        await graph.settle()
        robot.title = "hero"
        await seen.until(lambda: seen.parameters["/robot.title"] == "hero")


async def test_following_all(graph: Graph) -> None:
    """No name means all names, and at the end none; too many are refused."""
    robot = Robot()
    async with served(graph, robot) as lab, viewer(lab.port) as seen:
        await seen.send("subscribeParameterUpdates", parameterNames=[])
        await seen.send("getParameters", parameterNames=["/robot.gain"], id="x")
        await seen.until(lambda: "/robot.gain" in seen.parameters)
        robot.title = "hero"
        await seen.until(lambda: seen.parameters.get("/robot.title") == "hero")
        await seen.send("unsubscribeParameterUpdates", parameterNames=[])
        await seen.send("subscribeParameterUpdates", parameterNames=[f"/robot.a{n}" for n in range(5000)])
        await seen.send("subscribeParameterUpdates", parameterNames=["/robot.b"])
        await seen.until(lambda: seen.statuses)
        assert "cannot follow more than" in seen.statuses[0]
        robot.title = "zero"
        await graph.settle()
        await seen.send("getParameters", parameterNames=["/robot.gain"], id="y")
        await seen.until(lambda: seen.parameters["/robot.gain"] == 1.0)
        assert seen.parameters["/robot.title"] == "hero"


async def test_numbers_that_json_has_not(graph: Graph) -> None:
    """Non-finite numbers become strings, without affecting the others."""
    robot = Robot()
    async with served(graph, robot) as lab, viewer(lab.port) as seen:
        robot.limit = float("inf")
        await seen.send("getParameters", parameterNames=[], id="all")
        await seen.until(lambda: "/robot.limit" in seen.parameters)
        assert (seen.parameters["/robot.limit"], seen.parameters["/robot.gain"]) == ("inf", 1.0)
        await seen.say('{"op": "setParameters", "parameters": [{"name": "/robot.gain", "value": 1' + "0" * 400 + "}]}")
        await seen.until(lambda: seen.statuses)
        assert robot.gain == 1.0


async def test_hidden_nodes(graph: Graph) -> None:
    """Their parameters are not listed."""
    await graph.start(Robot("_tool"))
    async with served(graph, Robot()) as lab, viewer(lab.port) as seen:
        await seen.send("getParameters", parameterNames=[], id="all")
        await seen.until(lambda: "/robot.gain" in seen.parameters)
        assert not [name for name in seen.parameters if "_tool" in name]
