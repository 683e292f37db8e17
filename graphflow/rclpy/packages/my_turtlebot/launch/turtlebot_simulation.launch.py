"""The simulated TurtleBot3 of TURTLEBOT3_MODEL in a world: the argument `world`, by default `hexagon`."""

import os

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    model = os.environ.get("TURTLEBOT3_MODEL", "burger").replace("waffle_pi", "waffle")
    parameters = [{"world": LaunchConfiguration("world"), "model": model}]
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "world", default_value="hexagon", description="hexagon, house, maze, empty, or a file."
            ),
            Node(package="turtlebot3_gazebo", executable="simulator", parameters=parameters),
        ]
    )
