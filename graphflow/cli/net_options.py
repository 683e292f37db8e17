"""`--connect` and `--net`: the options that reach other machines, of `graphflow` itself and of some verbs."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TypeVar

import click

from graphflow.errors import UsageFault

F = TypeVar("F", bound=Callable[..., object])

# Copies of the names in transport.config: importing that would import Zenoh.
_CONNECT, _NET = "GRAPHFLOW_CONNECT", "GRAPHFLOW_NET"


def reach_options(command: F) -> F:
    """Add the options `--connect` and `--net` to a command."""
    connect = click.option(
        "--connect",
        multiple=True,
        metavar="tcp/HOST:7447",
        help=f"Link this machine to a router elsewhere, such as a ROS 2 robot's; else {_CONNECT}.",
    )
    net = click.option(
        "--net",
        type=click.Path(exists=True, dir_okay=False, resolve_path=True),
        metavar="PROFILE.yaml",
        help=f"Let others reach this machine, encrypted as the net profile says; else {_NET}.",
    )
    return connect(net(command))


def apply_reach(connect: tuple[str, ...], net: str | None) -> None:
    """Set the environment variables that the transport reads to the options' values.

    Raises:
        UsageFault: An endpoint is misspelt.
    """
    if connect:
        from graphflow.graph.zenoh_address import endpoint

        for text in connect:
            try:
                endpoint(text)
            except ValueError as error:
                raise UsageFault(f"--connect: {error}") from None
        os.environ[_CONNECT] = " ".join(connect)
    if net is not None:
        os.environ[_NET] = net
