"""The simulator of robots as a node."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

from graphflow import GraphflowError, Node
from graphflow.msgs.geometry_msgs.msg import Twist, TwistStamped, Vector3
from graphflow.msgs.nav_msgs.msg import Odometry
from graphflow.msgs.rosgraph_msgs.msg import Clock
from graphflow.msgs.sensor_msgs.msg import BatteryState, Imu, JointState, LaserScan
from graphflow.msgs.std_msgs.msg import Bool
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph
from graphflow.tf import Transforms
from nodes.robot_simulator import RobotSimulator
from tests.cases import slow

FORWARD = Twist(linear=Vector3(x=0.2))


class Listener(Node):
    tf = Transforms()


@slow
async def test_topics_and_rates(graph: Graph) -> None:
    """Each sensor has the rate of the real one, by simulated time."""
    await graph.start(RobotSimulator())
    kinds: dict[str, Any] = {"scan": LaserScan, "odom": Odometry, "imu": Imu, "joint_states": JointState}
    taps = {name: graph.tap(kind, f"/{name}") for name, kind in {**kinds, "battery_state": BatteryState}.items()}
    clock = graph.tap(Clock, "/clock")
    await graph.clock.advance(2.0)
    counts = {name: len(tap) for name, tap in taps.items()}
    assert counts == pytest.approx({"scan": 10, "odom": 60, "imu": 400, "joint_states": 60, "battery_state": 2}, abs=2)
    assert clock.latest.clock.sec + clock.latest.clock.nanosec / 1e9 == pytest.approx(2.0, abs=0.02)
    assert len(taps["scan"].latest.ranges) == 360


@pytest.mark.parametrize("kind", [Twist, TwistStamped])
async def test_commands_and_frames(graph: Graph, kind: Any) -> None:
    """Both types drive it; its frames are those of a TurtleBot3, and the scanner is where it belongs."""
    listener = Listener(use_sim_time=True)
    await graph.start(RobotSimulator(world="empty", stamped=kind is TwistStamped), listener)
    drive = graph.publisher(kind, "/cmd_vel")
    for _ in range(10):
        drive.publish(FORWARD if kind is Twist else TwistStamped(twist=FORWARD))
        await graph.clock.advance(0.2)
    scanner = listener.tf.get("odom", "base_scan")
    assert scanner.translation == pytest.approx((0.37 - 0.032, 0.0, 0.182), abs=0.04)
    assert listener.tf.parent("wheel_left_link") == "base_link"
    assert abs(listener.tf.get("base_link", "wheel_left_link").translation[1]) == pytest.approx(0.08)


async def test_frames_of_the_parts(graph: Graph) -> None:
    """They are where the TurtleBot3's description has them."""
    listener = Listener(use_sim_time=True)
    await graph.start(RobotSimulator(world="empty"), listener)
    await graph.clock.advance(0.1)
    places = {name: listener.tf.get("base_link", name).translation for name in listener.tf.frames if name != "odom"}
    assert places["base_scan"] == pytest.approx((-0.032, 0.0, 0.172))
    assert places["imu_link"] == pytest.approx((-0.032, 0.0, 0.068))
    assert places["wheel_left_link"] == pytest.approx((0.0, 0.08, 0.023))
    assert places["wheel_right_link"] == pytest.approx((0.0, -0.08, 0.023))


@slow
async def test_contents(graph: Graph, tmp_path: Any) -> None:
    """Gravity and turns in the IMU's, the period in a scan, the current out of the battery; a touch at once."""
    file = tmp_path / "wall.yaml"
    file.write_text("robots: [{}]\nwalls: [{points: [[0.3, -1.0], [0.3, 1.0]]}]")
    await graph.start(RobotSimulator(world=str(file)))
    imu, scans = graph.tap(Imu, "/imu"), graph.tap(LaserScan, "/scan")
    battery, bumper = graph.tap(BatteryState, "/battery_state"), graph.tap(Bool, "/bumper")
    drive = graph.publisher(Twist, "/cmd_vel")
    for _ in range(5):
        drive.publish(Twist(angular=Vector3(z=0.5)))
        await graph.clock.advance(0.1)
    assert imu.latest.linear_acceleration.z == pytest.approx(9.81, abs=0.3)
    assert imu.latest.angular_velocity.z == pytest.approx(0.5, abs=0.1)
    assert scans.latest.scan_time == pytest.approx(0.2)
    assert battery.latest.current < -0.3
    for _ in range(30):
        drive.publish(FORWARD)
        await graph.clock.advance(0.1)
    touches = [message.data for message in bumper]
    assert True in touches
    assert len(touches) > len(battery)


async def test_pause_and_reset(graph: Graph) -> None:
    """Time stands still, or begins again."""
    node = RobotSimulator(world="empty", rate=2.0)
    await graph.start(node)
    await graph.clock.advance(1.0)
    assert node.simulation.time == pytest.approx(2.0, abs=0.03)
    await graph.call(Empty, "/pause_physics", Empty.Request())
    await graph.clock.advance(1.0)
    paused = node.simulation.time
    await graph.clock.advance(1.0)
    assert node.simulation.time == paused
    await graph.call(Empty, "/reset_simulation", Empty.Request())
    await graph.call(Empty, "/unpause_physics", Empty.Request())
    odoms = graph.tap(Odometry, "/odom")
    await graph.clock.advance(0.5)
    assert node.simulation.time == pytest.approx(1.0, abs=0.05)
    assert len(odoms) > 25


async def test_several_robots(graph: Graph, tmp_path: Any) -> None:
    """Topics and frames are below the names."""
    file = tmp_path / "two.yaml"
    file.write_text("robots: [{name: a}, {name: b, at: [1.0, 0.0]}]")
    node, listener = RobotSimulator(world=str(file)), Listener()
    await graph.start(node, listener)
    drive = graph.publisher(Twist, "/b/cmd_vel")
    drive.publish(FORWARD)
    await graph.clock.advance(0.5)
    assert node.simulation.robots["b"].pose.x > 1.02
    assert node.simulation.robots["a"].pose.x == pytest.approx(0.0, abs=0.01)
    assert {"a/base_scan", "b/base_scan", "a/odom"} <= set(listener.tf.frames)


async def test_commands_that_are_none_and_robots_in_trouble(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Both are reported, once, and the simulation goes on."""
    node = RobotSimulator(world="empty")
    await graph.start(node)
    drive = graph.publisher(Twist, "/cmd_vel")
    drive.publish(Twist(linear=Vector3(x=float("nan"))))
    await graph.clock.advance(0.1)
    told = "cmd_vel: a velocity of nan m/s and 0.0 rad/s is not a command, and is left out; /"
    assert told in caplog.text
    node.simulation.robots[""].place(500.0, 0.0, 0.0)
    await graph.clock.advance(0.5)
    assert caplog.text.count("robot burger: it has left the world; call reset_simulation") == 1
    await graph.call(Empty, "/reset_simulation", Empty.Request())
    await graph.clock.advance(0.1)
    assert node.simulation.robots[""].trouble == ""


@pytest.mark.parametrize(
    ("world", "text"),
    [("hexagn", "there is no world 'hexagn'; did you mean 'hexagon'"), ("/nope.yaml", "there is no file /nope.yaml")],
)
async def test_a_world_that_is_not_there(graph: Graph, world: str, text: str) -> None:
    """The node does not start, and says what there is."""
    with pytest.raises(GraphflowError, match=text):
        await graph.start(RobotSimulator(world=world))


async def test_without_mujoco(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """The error is the line that installs it."""
    monkeypatch.setitem(sys.modules, "mujoco", None)
    monkeypatch.delitem(sys.modules, "graphflow.simulator.simulation", raising=False)
    with pytest.raises(GraphflowError, match=r"the simulator needs MuJoCo: pip install .*\[sim\]"):
        await graph.start(RobotSimulator())


async def test_commands_without_effect(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Parts that a robot ignores, speeds beyond its own, and commands that end are told, once each."""
    await graph.start(RobotSimulator(world="empty"))
    drive = graph.publisher(Twist, "/cmd_vel")
    for _ in range(3):
        drive.publish(Twist(linear=Vector3(x=5.0, y=0.1), angular=Vector3(x=1.0, z=9.0)))
        await graph.clock.advance(0.1)
    await graph.clock.advance(1.5)
    for text in (
        "cmd_vel: linear.y is ignored: a burger drives by linear.x and turns by angular.z",
        "cmd_vel: angular.x is ignored",
        "cmd_vel asks for more than a burger can: it drives at most 0.22 m/s",
        "cmd_vel asks for more than a burger can: it turns at most by 2.84 rad/s",
        "no cmd_vel for 1 s: it stops; publish again and again, from a timer",
    ):
        assert caplog.text.count(text) == 1, text


async def test_commands_of_the_other_type(graph: Graph) -> None:
    """A program that stamps its commands drives the robot, and so does one that does not."""
    node = RobotSimulator(world="empty")
    await graph.start(node)
    plain, stamped = graph.publisher(Twist, "/cmd_vel"), graph.publisher(TwistStamped, "/cmd_vel")
    await graph.clock.advance(1.1)
    start = node.simulation.robots[""].pose.x
    for _ in range(10):
        stamped.publish(TwistStamped(twist=FORWARD))
        await graph.clock.advance(0.1)
    halfway = node.simulation.robots[""].pose.x
    assert halfway - start > 0.1
    for _ in range(10):
        plain.publish(FORWARD)
        await graph.clock.advance(0.1)
    assert node.simulation.robots[""].pose.x - halfway > 0.1


@slow
async def test_two_nodes_that_steer(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """They are named once; one alone is not."""
    await graph.start(RobotSimulator(world="empty"))
    for name in ("teleop", "control"):
        assert "all publish" not in caplog.text
        driver = Node(name)
        await graph.start(driver)
        driver.create_publisher(Twist, "/cmd_vel", 10)
        await graph.clock.advance(2.5)
    [text] = [text for text in caplog.messages if "all publish" in text]
    assert "/control and /teleop all publish /cmd_vel, and the robot obeys the latest: stop all but one" in text


async def test_a_world_without_a_robot(graph: Graph, tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """The warning has the line to add."""
    (tmp_path / "bare.yaml").write_text("friction: 0.5")
    await graph.start(RobotSimulator(world=str(tmp_path / "bare.yaml")))
    assert "the world has no robot: add `robots: [{model: burger}]`, or call spawn_entity" in caplog.text
