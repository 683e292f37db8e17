"""A map from the scans of a robot that runs already."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    parameters = [{"use_sim_time": LaunchConfiguration("use_sim_time")}]
    return LaunchDescription(
        [
            DeclareLaunchArgument("use_sim_time", default_value="true", description="Whether the robot is simulated."),
            Node(package="cartographer_ros", executable="cartographer_node", name="mapper", parameters=parameters),
        ]
    )
