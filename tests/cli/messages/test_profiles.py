"""The QoS options of `topic echo` and `topic pub`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import click
import pytest

from graphflow.cli.messages.profiles import qos_options, take_qos
from graphflow.qos import DEFAULT, SENSOR_DATA, Durability, History, Liveliness, Qos, Reliability


@click.command()
@qos_options
def command(**options: Any) -> None:
    """Something with QoS."""


def taken(words: str, default: Qos = DEFAULT) -> Qos:
    return take_qos(command.make_context("command", words.split()).params, default)


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("", DEFAULT),
        ("--qos-profile sensor_data", SENSOR_DATA),
        ("--qos-depth 3", replace(DEFAULT, depth=3)),
        ("--qos-profile sensor_data --qos-depth 3", replace(SENSOR_DATA, depth=3)),
        ("--qos-reliability best_effort", replace(DEFAULT, reliability=Reliability.BEST_EFFORT)),
        ("--qos-durability transient_local", replace(DEFAULT, durability=Durability.TRANSIENT_LOCAL)),
        ("--qos-history keep_all", replace(DEFAULT, history=History.KEEP_ALL)),
        ("--qos-liveliness manual_by_topic", replace(DEFAULT, liveliness=Liveliness.MANUAL_BY_TOPIC)),
        ("--qos-liveliness-lease-duration-seconds 1.5", replace(DEFAULT, lease_ns=1_500_000_000)),
    ],
)
def test_what_an_option_changes(words: str, expected: Qos) -> None:
    """Only what it names; a profile is what the others begin with."""
    assert taken(words) == expected


def test_without_a_profile_it_begins_with_the_commands_own() -> None:
    """Policies without an option are the command's own."""
    assert taken("--qos-depth 3", replace(SENSOR_DATA, depth=100)) == replace(SENSOR_DATA, depth=3)


def test_the_options_are_taken_away() -> None:
    """The QoS options are removed, so that the rest can be passed on."""
    options = {**command.make_context("command", ["--qos-depth", "3"]).params, "once": True}
    take_qos(options, DEFAULT)
    assert options == {"once": True}


@pytest.mark.parametrize("words", ["--qos-depth 0", "--qos-history some", "--qos-profile best"])
def test_a_word_that_is_no_qos(words: str) -> None:
    """An unknown policy is wrong usage."""
    with pytest.raises(click.BadParameter):
        taken(words)
