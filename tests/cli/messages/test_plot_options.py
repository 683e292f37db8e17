"""The options of plots."""

from __future__ import annotations

from typing import Any

import click
from click.testing import CliRunner

from graphflow.cli.messages.plot_options import plot_options


def test_files_and_numbers() -> None:
    """The options have the names of `PlotOptions`."""
    taken: dict[str, Any] = {}

    @click.command()
    @plot_options
    def plot(**options: Any) -> None:
        taken.update(options)

    result = CliRunner().invoke(plot, ["--png", "a.png", "--svg", "b.svg", "--csv"])
    assert result.exit_code == 0, result.output
    assert taken == {"png": "a.png", "svg": "b.svg", "as_csv": True}
