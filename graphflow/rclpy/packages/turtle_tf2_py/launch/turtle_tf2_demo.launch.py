"""ROS's tf2 tutorial: a second turtle follows the first; drive that with turtle_teleop_key."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

SPAWN = ["ros2", "service", "call", "/spawn", "turtlesim/srv/Spawn", "{x: 4.0, y: 2.0, theta: 0.0, name: turtle2}"]


def broadcaster(name: str, turtle: str) -> Node:
    return Node(
        package="turtle_tf2_py",
        executable="turtle_tf2_broadcaster",
        name=name,
        parameters=[{"turtlename": turtle}],
        remappings=[("pose", f"/{turtle}/pose")],
    )


def generate_launch_description() -> LaunchDescription:
    target = {"target_frame": LaunchConfiguration("target_frame")}
    return LaunchDescription(
        [
            DeclareLaunchArgument("target_frame", default_value="turtle1", description="The frame to follow."),
            Node(package="turtlesim", executable="turtlesim_node", name="sim"),
            ExecuteProcess(cmd=SPAWN),
            broadcaster("broadcaster1", "turtle1"),
            broadcaster("broadcaster2", "turtle2"),
            Node(
                package="turtle_tf2_py",
                executable="turtle_tf2_listener",
                name="listener",
                parameters=[target],
                remappings=[("cmd_vel", "/turtle2/cmd_vel")],
            ),
        ]
    )
