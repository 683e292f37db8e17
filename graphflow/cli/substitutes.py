"""Graphflow's substitutes for programs of ROS that it does not have."""

from __future__ import annotations

ROBOT_VIEWS = (
    "in its place: graphflow attach, then :map, :tf, :scan, :image and :joints; in 3-D, graphflow view for Foxglove"
)
_SIMULATOR = "in its place there is a simulator on MuJoCo: graphflow up tb_sim"
_NAVIGATION = "in its place: graphflow up tb_map drive:=false, whose map and `g` send the robot to a place"
_DESCRIPTION = "in its place: graphflow run robot_state_publisher FILE.urdf, and graphflow view --rerun or :joints"
PACKAGES = {
    **dict.fromkeys(("rviz2", "rviz"), ROBOT_VIEWS),
    **dict.fromkeys(("rqt_gui", "rqt_console"), "in its place: graphflow attach"),
    **dict.fromkeys(("rqt_image_view", "image_view"), "in its place: graphflow attach, then :image"),
    "rqt_plot": "in its place: graphflow topic plot TOPIC.FIELD",
    **dict.fromkeys(("ros_gz_sim", "gazebo_ros"), _SIMULATOR),
    **dict.fromkeys(("nav2_bringup", "turtlebot3_navigation2", "nav2_simple_commander"), _NAVIGATION),
    **dict.fromkeys(("urdf_tutorial", "urdf_launch", "turtlebot3_description"), _DESCRIPTION),
    "turtlebot3_bringup": f"it drives the real robot; for the simulated one: graphflow up tb_sim; rviz2: {ROBOT_VIEWS}",
    "xacro": "write it without its package: xacro FILE.urdf.xacro",
}
"""Packages that draw on a screen or are not there, and what to use."""


def no_package(package: str) -> str:
    """Return the sentence for a package that has a substitute; "" for another."""
    return f"there is no package {package!r}; {PACKAGES[package]}" if package in PACKAGES else ""
