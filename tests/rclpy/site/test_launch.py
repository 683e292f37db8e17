"""ROS's launch packages, as modules that code other than launch files imports."""

from __future__ import annotations

import launch
import launch_ros
import pytest
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def test_they_remember_what_they_are_called_with() -> None:
    """A helper that makes nodes for launch files can be imported, called and looked at."""
    made = launch.LaunchDescription([DeclareLaunchArgument("x"), Node(package="p", executable="e")])
    assert isinstance(made, launch.LaunchDescription)
    assert [type(one).__name__ for one in made.args[0]] == ["DeclareLaunchArgument", "Node"]
    assert isinstance(made.args[0][1], launch_ros.actions.Node)
    assert str(LaunchConfiguration("x")) == "$(var x)"
    assert launch.substitutions.LaunchConfiguration is LaunchConfiguration


def test_there_is_only_what_launch_has() -> None:
    """Other packages are not made up."""
    with pytest.raises(ModuleNotFoundError):
        __import__("launch_elsewhere")
    assert not hasattr(launch, "__wrapped__")
