"""Two simulators beside each other, each in a namespace of its own."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    names = ("turtlesim1", "turtlesim2")
    return LaunchDescription(
        [Node(package="turtlesim", executable="turtlesim_node", namespace=name, output="screen") for name in names]
    )
