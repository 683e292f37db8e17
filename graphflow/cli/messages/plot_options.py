"""The options that `topic plot` and `bag plot` share."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

F = TypeVar("F", bound=Callable[..., Any])


def plot_options(command: F) -> F:
    """Add what says where the picture goes."""
    file = click.Path(dir_okay=False)
    for add in (
        click.option("--csv", "as_csv", is_flag=True, help="The numbers themselves: seconds, name, value."),
        click.option("--png", type=file, help="Into a PNG file."),
        click.option("--svg", type=file, help="Into an SVG file."),
    ):
        command = add(command)
    return command
