"""The options that `topic echo` and `service echo` share, named as in ROS 2."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypeVar

import click

from graphflow.cli.messages.profiles import qos_options, take_qos
from graphflow.errors import UsageFault
from graphflow.qos import BEST_AVAILABLE, Qos

F = TypeVar("F", bound=Callable[..., object])


@dataclass
class EchoOptions:
    """The options of `topic echo`, under click's names."""

    once: bool = False
    timeout: float | None = None
    field: str | None = None
    condition: str = ""
    flow_style: bool = False
    csv: bool = False
    raw: bool = False
    no_arr: bool = False
    no_str: bool = False
    full_length: bool = False
    truncate_length: int = 128
    include_message_info: bool = False
    no_lost_messages: bool = False
    clear: bool = False
    node_name: str | None = None
    as_json: bool = False
    qos: Qos = BEST_AVAILABLE


def echo_options(command: F) -> F:
    """Add `--once`, `--field` and the other options to a command."""
    option, flag = click.option, partial(click.option, is_flag=True)
    options = [
        flag("--once", help="Exit after the first message."),
        option("--timeout", type=click.FloatRange(0, min_open=True), help="Seconds to wait for the first message."),
        option("--field", help="Show only this part, such as linear.x or ranges[0]."),
        option("--filter", "condition", default="", help="Only messages m for which this holds: 'm.data > 3'."),
        flag("--flow-style", help="Print each field on one line."),
        flag("--csv", help="Print comma-separated values."),
        flag("--raw", help="Print the bytes of the message."),
        flag("--no-arr", help="Leave out the elements of arrays."),
        flag("--no-str", help="Leave out the text of strings."),
        flag("-f", "--full-length", help="Show long arrays and strings in full."),
        option("-l", "--truncate-length", type=click.IntRange(1), default=128, help="Longest array or string. [128]"),
        flag("-i", "--include-message-info", help="Also show sequence number, time and sender."),
        flag("--no-lost-messages", help="Do not report lost messages."),
        flag("-c", "--clear", help="Clear the screen before each message."),
        option("-n", "--node-name", help="Name of the listening node."),
        qos_options,
        flag("--json", "as_json", help="Print one JSON object per line."),
    ]
    for add in reversed(options):
        command = add(command)
    return command


def collect_options(options: dict[str, Any]) -> EchoOptions:
    """Collect the options from click's; by default, the QoS is compatible with all current publishers."""
    if (options["node_name"] or "").isdigit():
        raise UsageFault("-n is the name of the listening node; to end after the first message: --once")
    options["qos"] = take_qos(options, replace(BEST_AVAILABLE, depth=100))
    return EchoOptions(**options)
