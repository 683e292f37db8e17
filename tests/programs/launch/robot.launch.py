"""A launch file as courses have them, with most of what they use."""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    EmitEvent,
    ExecuteProcess,
    GroupAction,
    IncludeLaunchDescription,
    LogInfo,
    OpaqueFunction,
    RegisterEventHandler,
    SetEnvironmentVariable,
    Shutdown,
    TimerAction,
)
from launch.conditions import IfCondition, LaunchConfigurationEquals, UnlessCondition
from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import (
    EnvironmentVariable,
    LaunchConfiguration,
    PathJoinSubstitution,
    PythonExpression,
    TextSubstitution,
)
from launch_ros.actions import ComposableNodeContainer, Node, PushRosNamespace, SetROSLogDir
from launch_ros.descriptions import ComposableNode
from launch_ros.substitutions import FindPackageShare


def more(context, *args):
    return [Node(package="demo_nodes_py", executable="listener", name=LaunchConfiguration("who").perform(context))]


def generate_launch_description():
    print("describing")
    share = get_package_share_directory("robot")
    speed = LaunchConfiguration("speed", default="1.0")
    sim = Node(
        package="turtlesim",
        executable="turtlesim_node",
        name="sim",
        output="screen",
        parameters=[
            {"background_r": 10, "name": "5", "gain": speed, "list": [1.0, 2.0], "n": {"a": True}},
            os.path.join(share, "config", "params.yaml"),
        ],
        remappings=[("/turtle1/cmd_vel", "/cmd_vel")],
    )
    spawn = ExecuteProcess(
        cmd=["ros2", "service", "call", "/spawn", "turtlesim/srv/Spawn", "\"{x: 2, y: 2, name: 't2'}\""], shell=True
    )
    description = LaunchDescription(
        [
            DeclareLaunchArgument("speed", default_value="1.0", description="m/s"),
            DeclareLaunchArgument("who", default_value=TextSubstitution(text="leo"), choices=["leo", "don"]),
            SetEnvironmentVariable("A", EnvironmentVariable("B", default_value="c")),
            sim,
            RegisterEventHandler(OnProcessStart(target_action=sim, on_start=[spawn])),
            RegisterEventHandler(
                OnProcessExit(target_action=sim, on_exit=[LogInfo(msg="over"), ExecuteProcess(cmd=["echo", "over"])])
            ),
            RegisterEventHandler(OnProcessExit(target_action=sim, on_exit=[EmitEvent(event=Shutdown())])),
            RegisterEventHandler(OnProcessIO(target_action=sim)),
            GroupAction(
                [
                    PushRosNamespace("robot1"),
                    Node(
                        package="demo_nodes_py",
                        executable="talker",
                        condition=UnlessCondition(LaunchConfiguration("quiet")),
                        on_exit=Shutdown(),
                    ),
                ]
            ),
            GroupAction(
                condition=IfCondition(PythonExpression(["'", LaunchConfiguration("who"), "' == 'leo'"])),
                actions=[
                    Node(
                        package="rviz2",
                        executable="rviz2",
                        arguments=["-d", PathJoinSubstitution([FindPackageShare("robot"), "rviz", "a.rviz"])],
                    )
                ],
            ),
            TimerAction(period=5.0, actions=[Node(package="demo_nodes_cpp", executable="listener", respawn=True)]),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource([FindPackageShare("robot"), "/launch/b.launch.py"]),
                launch_arguments={"speed": speed}.items(),
                condition=LaunchConfigurationEquals("who", "don"),
            ),
            OpaqueFunction(function=more),
            ComposableNodeContainer(
                name="c",
                namespace="",
                package="p",
                executable="e",
                composable_node_descriptions=[
                    ComposableNode(
                        package="composition",
                        plugin="composition::Talker",
                        name="t",
                        parameters=[{"rate": 2.0}],
                        remappings=[("chatter", "news")],
                    )
                ],
            ),
            SetROSLogDir(new_log_dir="logs"),
        ]
    )
    description.add_action(LogInfo(msg="last"))
    return description
