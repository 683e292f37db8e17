"""Publishing by viewers."""

from __future__ import annotations

import json

import pytest

from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.testing import Graph
from graphflow.viewer import publications
from tests.viewer.cast import Robot, served, viewer

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_publishing(graph: Graph) -> None:
    """CDR and JSON are published; malformed messages are reported and not published."""
    robot = Robot()
    async with served(graph, robot) as lab, viewer(lab.port) as seen:
        channels = [
            {"id": 1, "topic": "/cmd_vel", "encoding": "cdr", "schemaName": "geometry_msgs/msg/Twist"},
            {"id": 2, "topic": "/cmd_vel", "encoding": "json", "schemaName": "geometry_msgs/Twist"},
            {"id": 3, "topic": "/cmd_vel", "encoding": "cdr", "schemaName": "geometry_msgs/msg/Twits"},
            {"id": 4, "topic": "/no//name", "encoding": "cdr", "schemaName": "geometry_msgs/msg/Twist"},
            {"id": 5, "topic": "/cmd_vel", "encoding": "protobuf", "schemaName": "geometry_msgs/msg/Twist"},
            {"id": 6, "topic": "/cmd_vel", "encoding": "json", "schemaName": "std_srvs/srv/SetBool"},
        ]
        await seen.send("advertise", channels=channels)
        await seen.until(lambda: len(seen.statuses) == 4)
        assert "did you mean 'Twist'?" in " ".join(seen.statuses)
        await graph.settle()
        await seen.publish(1, Twist(linear=Vector3(x=1.0)).to_bytes())
        await seen.until(lambda: len(robot.heard) == 1)
        await seen.publish(2, json.dumps({"linear": {"x": 2.0}}).encode())
        await seen.until(lambda: len(robot.heard) == 2)
        assert [twist.linear.x for twist in robot.heard] == [1.0, 2.0]
        wrong = (
            (1, b"\x00\x01\x00\x00short"),
            (2, b"{"),
            (2, b'{"liner": 1}'),
            (2, b"[" * 100_000),
            (2, b"\xff"),
            (3, b"x"),
        )
        for channel, data in wrong:
            await seen.publish(channel, data)
        await seen.until(lambda: len(seen.statuses) == 10)
        assert "liner" in " ".join(seen.statuses)
        assert len(robot.heard) == 2
        await seen.send("unadvertise", channelIds=[1, 2])
        await seen.until(lambda: not len(lab.bridge._publications))
    assert len(robot.heard) == 2


async def test_publishers_of_a_viewer_that_has_gone(graph: Graph) -> None:
    """The publishers of a viewer end with it."""
    async with served(graph, Robot()) as lab:
        async with viewer(lab.port) as seen:
            channel = {"id": 1, "topic": "/cmd_vel", "encoding": "cdr", "schemaName": "geometry_msgs/msg/Twist"}
            await seen.send("advertise", channels=[channel])
            await seen.until(lambda: len(lab.bridge._publications))
        await seen.until(lambda: not len(lab.bridge._publications))


async def test_too_many_publishers(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Publishers beyond the limit are refused."""
    monkeypatch.setattr(publications, "BOUND", 2)
    async with served(graph, Robot()) as lab, viewer(lab.port) as seen:
        channel = {"topic": "/cmd_vel", "encoding": "cdr", "schemaName": "geometry_msgs/msg/Twist"}
        await seen.send("advertise", channels=[{"id": number, **channel} for number in range(3)])
        await seen.until(lambda: seen.statuses)
        assert seen.statuses == ["viewers already have 2 publishers"]
        assert len(lab.bridge._publications) == 2
