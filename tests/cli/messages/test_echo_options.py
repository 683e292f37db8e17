"""The options that two verbs share."""

from __future__ import annotations

from typing import Any

import click
from click.testing import CliRunner

from graphflow.cli.messages.echo_options import EchoOptions, collect_options, echo_options
from graphflow.qos import BEST_AVAILABLE, Reliability


def test_every_option_has_its_place() -> None:
    """Every option of click's is one of `EchoOptions`."""
    found: list[EchoOptions] = []

    @click.command()
    @echo_options
    def echo(**options: Any) -> None:
        found.append(collect_options(options))

    runner = CliRunner()
    assert runner.invoke(echo, []).exit_code == 0
    words = "--once --timeout 2 --field a --filter m --raw -f -l 5 -i -c -n x --json --qos-reliability best_effort"
    assert runner.invoke(echo, words.split()).exit_code == 0
    plain, full = found
    assert plain == EchoOptions(qos=plain.qos)
    assert (plain.qos.depth, plain.qos.reliability) == (100, BEST_AVAILABLE.reliability)
    assert (full.once, full.timeout, full.condition, full.truncate_length, full.node_name) == (True, 2.0, "m", 5, "x")
    assert full.raw
    assert full.clear
    assert full.qos.reliability is Reliability.BEST_EFFORT
