"""The launch files of courses: a TurtleBot3, and two turtles."""

from __future__ import annotations

import pytest

from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real


@slow
@pytest.mark.parametrize("name", ["turtlebot3_world", "turtlebot3_house", "empty_world"])
def test_launching_a_world(machine: Machine, name: str) -> None:
    """The robot of TURTLEBOT3_MODEL is there, with its topics."""
    machine.env["TURTLEBOT3_MODEL"] = "waffle_pi"
    up = machine.start("launch", "turtlebot3_gazebo", f"{name}.launch.py")
    up.wait_for("is up: 1 node")
    up.wait_for(": waffle")
    topics = machine.look("topic", "list")
    assert all(f"/{topic}\n" in topics for topic in ("scan", "odom", "cmd_vel", "imu", "joint_states", "tf", "clock"))
    assert "frame_id: base_scan" in machine.look("topic", "echo", "/scan", "--once", "--no-arr")
    assert up.end() == 0


@slow
@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("my_turtlebot", "turtlebot_simulation.launch.py", "world:=empty"), "world empty: burger"),
        (("aro_reactive_control", "hw01_sim.launch.xml"), "[reactive_control]: drive"),
        (("turtlebot3_cartographer", "cartographer.launch.py"), "is up: 1 node"),
        (("turtlesim", "multisim.launch.py"), "[turtlesim2.turtlesim]: Spawning turtle"),
        (("slam_toolbox", "online_async_launch.py"), "is up: 1 node"),
    ],
)
def test_launch_files_of_courses(machine: Machine, words: tuple[str, ...], told: str) -> None:
    """They start as they stand on the slides."""
    up = machine.start("launch", *words)
    up.wait_for(told)
    assert up.end() == 0


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("rviz2",), "in its place: graphflow attach, then :map, :tf"),
        (("run", "rviz2", "rviz2"), "there is no package 'rviz2'; in its place: graphflow attach, then :map"),
        (("gz", "sim"), "in its place there is a simulator on MuJoCo: graphflow up tb_sim"),
        (("run", "rqt_plot", "rqt_plot"), "in its place: graphflow topic plot TOPIC.FIELD"),
    ],
)
def test_programs_with_windows(machine: Machine, words: tuple[str, ...], told: str) -> None:
    """What stands for them here is named."""
    assert told in machine.look(*words, code=2)


@slow
def test_teleoperation_without_a_terminal(machine: Machine) -> None:
    """It says where to run it."""
    told = machine.run("run", "turtlebot3_teleop", "teleop_keyboard", code=1)
    assert "run teleop_keyboard in its own terminal" in told
