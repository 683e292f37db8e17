"""The base class of controllers."""

import math

import pytest

from graphflow import ParameterError
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.testing import Graph
from nodes.position_controller import Point, PositionController, distance, steer


class Patient(PositionController):
    """Record its callbacks."""

    def __init__(self) -> None:
        super().__init__()
        self.diary: list[str] = []

    async def arrived(self) -> None:
        self.diary.append("arrived")

    async def departed(self) -> None:
        self.diary.append("departed")


@pytest.mark.parametrize(
    ("theta", "turning", "driving"),
    [
        (0.0, 5 * math.pi / 2, 0.0),
        (math.pi / 2, 0.0, 1.5),
        (math.pi / 6, 5 * math.pi / 3, 0.75),
        (math.pi, -5 * math.pi / 2, 0.0),
        (-3.0, 5 * (math.pi / 2 + 3.0 - math.tau), 0.0),
    ],
)
def test_steering_turns_the_short_way(theta: float, turning: float, driving: float) -> None:
    """Towards a goal straight above, by the gain times the angle that is missing, and onwards as far as it leads."""
    twist = steer(Pose(x=1.0, y=1.0, theta=theta), Point(1.0, 4.0), gain=5.0, speed=1.5)

    assert twist.linear.x == pytest.approx(driving, abs=1e-12)
    assert twist.angular.z == pytest.approx(turning)


@pytest.mark.parametrize("late", [0.0, 0.03, 0.06, 0.09])
@pytest.mark.parametrize("speed", [1.0, 2.0, 3.0])
def test_a_goal_that_is_missed_is_reached_all_the_same(late: float, speed: float) -> None:
    """It does not circle the goal for ever, at any phase of its timer."""
    goal, pose = Point(5.0, 9.0), Pose(x=2.0 + late * speed, y=1.0, theta=3.0)
    for _ in range(150):
        if distance(pose, goal) <= 0.1:
            return
        twist = steer(pose, goal, gain=5.0, speed=speed)
        for _ in range(6):  # turtlesim's frames
            pose.theta += twist.angular.z / 60
            pose.x += twist.linear.x * math.cos(pose.theta) / 60
            pose.y += twist.linear.x * math.sin(pose.theta) / 60
    pytest.fail(f"at {pose.x:.2f}, {pose.y:.2f} after 15 s")


def test_distance_is_euclidean() -> None:
    """Three and four make five."""
    assert distance(Pose(x=1.0, y=1.0), Point(4.0, 5.0)) == 5.0


async def test_it_waits_for_a_pose_and_a_goal(graph: Graph) -> None:
    """It publishes no command before it knows both."""
    node = PositionController(speed=0.7)
    await graph.start(node)
    twists = graph.tap(Twist, "/cmd_vel")
    await graph.clock.advance(1.0)
    assert not twists
    graph.publisher(Pose, "/pose").publish(Pose(x=1.0))
    await graph.clock.advance(1.0)
    assert not twists

    node.goal = Point(5.0, 0.0)
    await graph.clock.advance(1.0)

    assert [t.linear.x for t in twists] == [0.7] * 10


async def test_hooks_are_called_once_each_way(graph: Graph) -> None:
    """It stops at the goal, leaves when it is moved, and calls each hook once."""
    node = Patient()
    node.goal = Point(5.0, 5.0)
    await graph.start(node)
    twists, pose = graph.tap(Twist, "/cmd_vel"), graph.publisher(Pose, "/pose")

    for x, diary in [(1.0, []), (4.95, ["arrived"]), (5.09, ["arrived"]), (6.0, ["arrived", "departed"])]:
        pose.publish(Pose(x=x, y=5.0))
        await graph.clock.advance(0.5)
        assert node.diary == diary
        assert (twists.latest == Twist()) == (4.9 <= x <= 5.1)


@pytest.mark.parametrize(("name", "value"), [("gain", 0.0), ("tolerance", 0.0), ("speed", -1.0)])
def test_limits_of_the_parameters(name: str, value: float) -> None:
    """A gain of zero never turns, a tolerance of zero is never reached."""
    with pytest.raises(ParameterError, match="out of range"):
        PositionController(overrides={name: (value, "test")})
