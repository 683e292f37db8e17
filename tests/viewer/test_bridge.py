"""A graph in a viewer, tested by a client of the protocol."""

from __future__ import annotations

import pytest
from websockets.exceptions import InvalidStatus

from graphflow import Node, Publisher
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.rosgraph_msgs.msg import Clock
from graphflow.qos import CLOCK
from graphflow.testing import Graph
from graphflow.viewer import client, protocol
from graphflow.viewer import server as server_module
from graphflow.viewer.bridge import connections
from tests.viewer.cast import Robot, served, viewer

pytestmark = pytest.mark.usefixtures("graphflow_runner")


async def test_what_a_viewer_is_told(graph: Graph) -> None:
    """A viewer receives topics with definitions, services, and the connection graph; removals are sent, too."""
    robot = Robot()
    async with served(graph, robot) as lab, viewer(lab.port) as seen:
        assert seen.info["name"] == "lab"
        assert {"clientPublish", "services", "parameters", "connectionGraph"} <= {*seen.info["capabilities"]}
        await seen.until(lambda: "/speed" in seen.channels)
        channel = seen.channels["/speed"]
        assert (channel["encoding"], channel["schemaName"]) == ("cdr", "geometry_msgs/msg/Twist")
        assert channel["schemaEncoding"] == "ros2msg"
        assert "MSG: geometry_msgs/Vector3" in channel["schema"]
        await seen.until(lambda: "/power" in seen.services)
        power = seen.services["/power"]
        assert power["type"] == "std_srvs/srv/SetBool"
        assert power["request"]["schemaName"] == "std_srvs/srv/SetBool_Request"
        assert power["request"]["schema"] == "bool data\n"
        assert not [name for name in seen.services if "parameters" in name]
        await seen.send("subscribeConnectionGraph")
        await seen.until(lambda: seen.graph)
        assert seen.graph["publishedTopics"]["/speed"] == ["/robot"]
        assert seen.graph["subscribedTopics"]["/cmd_vel"] == ["/robot"]
        assert seen.graph["advertisedServices"]["/power"] == ["/robot"]
        await graph.stop(robot)
        await seen.until(lambda: "/speed" not in seen.channels and "/power" not in seen.services)


async def test_only_looking(graph: Graph) -> None:
    """A read-only server refuses to publish, call or set."""
    robot = Robot()
    async with served(graph, robot, is_read_only=True) as lab, viewer(lab.port) as seen:
        assert not {"clientPublish", "services"} & {*seen.info["capabilities"]}
        channel = {"id": 1, "topic": "/cmd_vel", "encoding": "cdr", "schemaName": "geometry_msgs/msg/Twist"}
        await seen.send("advertise", channels=[channel])
        await seen.publish(1, Twist().to_bytes())
        await seen.send("setParameters", parameters=[{"name": "/robot.gain", "value": 2}], id="set")
        await seen.until(lambda: any("this server is read-only" in text for text in seen.statuses))
        await seen.subscribe(1, "/speed")
        await seen.until(lambda: robot.speed.get_subscription_count() == 1)
        assert (robot.gain, robot.heard, seen.services) == (1.0, [], {})


class Simulator(Node):
    """Publishes a clock."""

    clock_ = Publisher(Clock, "/clock", qos=CLOCK)


async def test_simulated_time(graph: Graph) -> None:
    """Viewers use simulated time if there is one."""
    node = Simulator()
    async with served(graph, node) as lab, viewer(lab.port) as seen:
        assert "time" in seen.info["capabilities"]
        await graph.settle()
        node.clock_.publish(Clock(clock={"sec": 5, "nanosec": 6}))
        await seen.until(lambda: seen.times == [5_000_000_006])


WRONG: list[str | bytes] = [
    "{",
    "[]",
    "[" * 100_000,
    '{"op": "no"}',
    '{"op": 5}',
    '{"op": "subscribe"}',
    '{"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 99}]}',
    '{"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 1}]}',
    '{"op": "subscribe", "subscriptions": [{"id": 1e99, "channelId": "1"}]}',
    '{"op": "unsubscribe", "subscriptionIds": [4294967296]}',
    '{"op": "getParameters", "parameterNames": [5]}',
    '{"op": "setParameters", "parameters": [{"name": "/robot.gain", "value": {"a": [1]}}]}',
    '{"op": "setParameters", "parameters": [{"name": "/robot.gain"}]}',
    '{"op": "setParameters", "parameters": [{"name": "", "value": 1}]}',
    '{"op": "advertise", "channels": [{"id": 1, "topic": "/a", "encoding": "cdr"}]}',
    b"",
    b"\xff\x00",
    b"\x01",
    b"\x01\x00\x00\x00\x00xyz",
    b"\x02\x00\x00\x00\x00",
    b"\x02" + bytes(8) + b"\xff\xff\xff\xff" + b"cdr",
    b"\x02" + bytes(8) + b"\x02\x00\x00\x00" + b"\xff\xff",
]


async def test_what_is_not_of_the_protocol(graph: Graph) -> None:
    """Each invalid message is answered with a warning, and affects nothing else."""
    robot = Robot()
    async with served(graph, robot) as lab, viewer(lab.port) as bad, viewer(lab.port) as good:
        for count, wrong in enumerate(WRONG, 1):
            await bad.say(wrong)
            await bad.until(lambda count=count: len(bad.statuses) >= count)  # type: ignore[misc]
        await good.subscribe(1, "/speed")
        await good.until(lambda: robot.speed.get_subscription_count() == 1)
        robot.speed.publish(Twist())
        await good.until(lambda: good.messages)
        assert robot.gain == 1.0


async def test_too_much_at_once(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Requests beyond the limit are refused."""
    monkeypatch.setattr(client, "WORK_BOUND", 2)
    monkeypatch.setattr(server_module, "CLIENTS_BOUND", 1)
    async with served(graph, Robot()) as lab, viewer(lab.port) as seen:
        with pytest.raises(InvalidStatus, match="503"):
            async with viewer(lab.port):
                pass
        for number in range(4):
            await seen.send("getParameters", parameterNames=[], id=str(number))
        await seen.until(lambda: "2 requests are under way already" in seen.statuses)


async def test_a_clock_that_comes_later(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Viewers that connect later use the clock; times before 1970 are ignored."""
    node = Simulator()
    async with served(graph) as lab:
        await graph.start(node)
        async with viewer(lab.port) as early:
            await early.until(lambda: "/clock" in early.channels)
        async with viewer(lab.port) as seen:
            assert "time" in seen.info["capabilities"]
            for sec in (-5, 7):
                node.clock_.publish(Clock(clock={"sec": sec}))
                await graph.settle()
            await seen.until(lambda: seen.times == [7_000_000_000])
    assert not [record for record in caplog.records if record.levelname == "ERROR"]


async def test_more_parameters_than_a_viewer_may_follow(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Parameters of several requests count together."""
    monkeypatch.setattr(protocol, "ENTRIES_BOUND", 1)
    async with served(graph, Robot()) as lab, viewer(lab.port) as seen:
        for name in ("/robot.gain", "/robot.title"):
            assert seen.statuses == []
            await seen.send("subscribeParameterUpdates", parameterNames=[name])
        await seen.until(lambda: seen.statuses)
        assert "a viewer cannot follow more than 1 parameters" in seen.statuses[0]


async def test_hidden_names_in_the_graph(graph: Graph) -> None:
    """Neither hidden topics nor hidden nodes are part of the connection graph."""
    robot, tool = Robot(), Robot("_tool")
    await graph.start(robot, tool)
    robot.create_publisher(Twist, "/a/_hidden")
    tool.create_publisher(Twist, "/of_tool")
    await graph.settle()
    published = connections(robot.context.cache)["publishedTopics"]
    assert published["/speed"] == ["/robot"]
    assert not {"/a/_hidden", "/of_tool"} & {*published}
