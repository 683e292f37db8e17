"""The simulated TurtleBot3 of TURTLEBOT3_MODEL in the world `empty`."""

import os

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    model = os.environ.get("TURTLEBOT3_MODEL", "burger").replace("waffle_pi", "waffle")
    parameters = [{"world": "empty", "model": model}]
    return LaunchDescription([Node(package="turtlebot3_gazebo", executable="simulator", parameters=parameters)])
