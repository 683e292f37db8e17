"""`graphflow rclpy`: whether Python itself imports rclpy from graphflow."""

from __future__ import annotations

import click

from graphflow.cli import output
from graphflow.errors import GraphflowError
from graphflow.rclpy import enabling


@click.group()
def rclpy() -> None:
    """Let plain `python` import rclpy, or not."""


@rclpy.command()
def enable() -> None:
    """Let this Python import rclpy, also outside graphflow's commands."""
    try:
        file = enabling.enable()
    except OSError as error:
        raise GraphflowError(
            f"{error.filename}: {error.strerror}; enable it in a virtual environment of your own"
        ) from None
    output.data(f"python imports rclpy from graphflow now: {file}")
    _say_who_wins()


@rclpy.command()
def disable() -> None:
    """Take back what `enable` did."""
    try:
        was_enabled = enabling.disable()
    except OSError as error:
        raise GraphflowError(f"{error.filename}: {error.strerror}") from None
    gone = f"python does not import rclpy from graphflow any more: {enabling.file()} is removed"
    output.data(gone if was_enabled else "it was not enabled; nothing is changed")


@rclpy.command()
def status() -> None:
    """Say what `import rclpy` means here."""
    other = enabling.elsewhere()
    if other is not None:
        output.data(f"a ROS 2 is sourced: rclpy is {other}")
    elif enabling.is_enabled():
        output.data(f"enabled: python imports rclpy from graphflow ({enabling.file()})")
    else:
        output.data("not enabled: only graphflow's own commands import rclpy; graphflow rclpy enable lets python do so")


def _say_who_wins() -> None:
    other = enabling.elsewhere()
    if other is not None:
        output.talk(f"but in this shell a ROS 2 is sourced, and wins: {other}")
