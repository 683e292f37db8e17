"""The options that `topic plot` and `bag plot` share."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import click

F = TypeVar("F", bound=Callable[..., object])


def plot_options(command: F) -> F:
    """Add the options for the output of a plot to a command."""
    file = click.Path(dir_okay=False)
    for add in (
        click.option("--csv", "as_csv", is_flag=True, help="Print the numbers: seconds, name, value."),
        click.option("--png", type=file, help="Write a PNG file."),
        click.option("--svg", type=file, help="Write an SVG file."),
    ):
        command = add(command)
    return command
