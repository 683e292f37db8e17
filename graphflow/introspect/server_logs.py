"""Warnings and errors that a server logs while a command waits for its response: a reason that the response lacks.

A response such as an empty name says only that something went wrong. What the server's node logs comes on /rosout.

Source: rcl_interfaces/msg/Log.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from contextlib import suppress
from typing import TYPE_CHECKING

from graphflow.errors import DecodeError, uncoloured

if TYPE_CHECKING:
    from graphflow.msgs.rcl_interfaces.msg import Log

TOPIC, TYPE = "/rosout", "rcl_interfaces/msg/Log"
SHOWN = 3
"""Different lines that are shown, at most."""
BOUND = 1000
"""Messages on /rosout that are kept, the newest: one node may log a flood."""
PATIENCE = 0.1
"""Seconds in which a line may still arrive after the response, which may overtake it."""
OVERTAKING = 0.005
"""Seconds by which a response may arrive before a line that was sent first: two threads receive them."""
_WORDS = {30: "a warning", 40: "an error", 50: "a fatal error"}
"""The levels that are shown."""


def read(payloads: Iterable[bytes]) -> Iterator[Log]:
    """Decode the messages on /rosout; those that are malformed are left out, since anybody may publish there."""
    from graphflow.msgs import registry

    codec = registry.codec(TYPE)
    for payload in payloads:
        with suppress(DecodeError):
            yield codec.decode(payload)


def lines(logs: Iterable[Log], nodes: Collection[str], known: str = "") -> list[str]:
    """Return the warnings and errors of some nodes among the messages on /rosout, as sentences, each once.

    Args:
        nodes: Full names of the nodes.
        known: A reason that is known already, and that a line need not repeat.
    """
    found: dict[str, None] = {}
    for log in logs:
        node = _node_of(log, nodes)
        if node and log.level in _WORDS and not (known and known in log.msg):
            found[f"meanwhile {node} logged {_WORDS[log.level]}: {uncoloured(log.msg)}"] = None
    return list(found)[-SHOWN:]


def _node_of(log: Log, nodes: Collection[str]) -> str:
    """Return the node whose logger, or a child of it, has logged a line; "" if it is none of them."""
    logger = str(log.name)
    names = {node.strip("/").replace("/", "."): node for node in nodes}
    return next((node for name, node in names.items() if logger == name or logger.startswith(f"{name}.")), "")
