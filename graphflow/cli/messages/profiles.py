"""The QoS options that `topic echo` and `topic pub` share, named as in ROS 2."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from enum import IntEnum
from typing import Any, TypeVar

import click

from graphflow.qos import PROFILES, Durability, History, Liveliness, Qos, Reliability
from graphflow.times import to_ns

F = TypeVar("F", bound=Callable[..., object])

_ENUMS: dict[str, type[IntEnum]] = {
    "history": History,
    "reliability": Reliability,
    "durability": Durability,
    "liveliness": Liveliness,
}


def qos_options(command: F) -> F:
    """Add `--qos-profile`, `--qos-depth` and the other QoS options to a command."""
    options = [
        click.option("--qos-profile", type=click.Choice(list(PROFILES)), help="Start from this profile."),
        click.option("--qos-depth", type=click.IntRange(1), help="Number of messages kept."),
        *(
            click.option(f"--qos-{name}", type=click.Choice([m.name.lower() for m in enum]), help=f"The {name} policy.")
            for name, enum in _ENUMS.items()
        ),
        click.option(
            "--qos-liveliness-lease-duration-seconds", type=click.FloatRange(0, min_open=True), help="Liveliness lease."
        ),
    ]
    for option in reversed(options):
        command = option(command)
    return command


def take_qos(options: dict[str, Any], default: Qos) -> Qos:
    """Remove the QoS options from a command's and return their QoS; policies not given are those of `default`."""
    profile = options.pop("qos_profile")
    given: dict[str, Any] = {"depth": options.pop("qos_depth")}
    for name, enum in _ENUMS.items():
        word = options.pop(f"qos_{name}")
        given[name] = enum[word.upper()] if word else None
    lease = options.pop("qos_liveliness_lease_duration_seconds")
    given["lease_ns"] = to_ns(lease) if lease else None
    return replace(PROFILES[profile] if profile else default, **{k: v for k, v in given.items() if v is not None})
