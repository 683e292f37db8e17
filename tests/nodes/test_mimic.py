"""A turtle that copies another."""

from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.testing import Graph
from nodes.mimic import Mimic


async def test_it_commands_what_the_other_one_drives(graph: Graph) -> None:
    """Its velocities, forwards and turning."""
    await graph.start(Mimic())
    commands = graph.tap(Twist, "/output/cmd_vel")
    graph.publisher(Pose, "/input/pose").publish(Pose(linear_velocity=1.5, angular_velocity=-0.5))
    await graph.settle()
    assert list(commands) == [Twist(linear=Vector3(x=1.5), angular=Vector3(z=-0.5))]
