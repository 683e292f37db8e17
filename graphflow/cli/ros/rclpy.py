"""`graphflow rclpy`: make rclpy importable from plain Python, or undo that."""

from __future__ import annotations

import click

from graphflow.cli import output
from graphflow.errors import GraphflowError
from graphflow.rclpy import enabling


@click.group()
def rclpy() -> None:
    """Make rclpy importable from plain `python`, or undo that."""


@rclpy.command()
def enable() -> None:
    """Make rclpy importable from this Python. It is otherwise only in graphflow's own commands."""
    try:
        file = enabling.enable()
    except OSError as error:
        raise GraphflowError(
            f"{error.filename}: {error.strerror}; enable it in a virtual environment of your own"
        ) from None
    output.data(f"python now imports rclpy from graphflow: {file}")
    _warn_of_ros()


@rclpy.command()
def disable() -> None:
    """Undo `graphflow rclpy enable`."""
    try:
        was_enabled = enabling.disable()
    except OSError as error:
        raise GraphflowError(f"{error.filename}: {error.strerror}") from None
    gone = f"python no longer imports rclpy from graphflow: {enabling.file()} was removed"
    output.data(gone if was_enabled else "it was not enabled; nothing was changed")


@rclpy.command()
def status() -> None:
    """Show which rclpy this Python imports."""
    other = enabling.elsewhere()
    if other is not None:
        output.data(f"a ROS 2 is sourced: rclpy is {other}")
    elif enabling.is_enabled():
        output.data(f"enabled: python imports rclpy from graphflow ({enabling.file()})")
    else:
        output.data("not enabled: only graphflow's own commands import rclpy; graphflow rclpy enable changes that")


def _warn_of_ros() -> None:
    other = enabling.elsewhere()
    if other is not None:
        output.talk(f"but a ROS 2 is sourced in this shell and takes precedence: {other}")
