"""Mistakes that are told when a node starts: slips in its class's source, and lists shared with other nodes."""

from __future__ import annotations

import logging
from collections.abc import Sequence

from graphflow.analysis.mistakes.calls.hidden_logs import HIDDEN
from graphflow.analysis.user_code import is_users_module
from graphflow.runtime.mistakes.source.module_variables import exchanged
from graphflow.runtime.part import Host
from graphflow.times import to_ns

ALONE_AFTER = 3.0
"""Seconds after which the other nodes of a process have started, too."""


def warn_of_variables(host: Host, instance: object) -> None:
    """Log, some seconds after a node's start, the variables of its module that a node of another process sets."""
    cls: type = type(instance)
    if not is_users_module(cls.__module__):
        return

    def check() -> None:
        present: set[type] = {type(node.instance) for node in host.context.nodes}
        for found in exchanged(cls):
            if not any(issubclass(kind, found.setter) for kind in present):
                host.log.warning("%s", found.text)

    if exchanged(cls):
        clock = host.context.clock
        clock.call_at(clock.monotonic_ns() + to_ns(ALONE_AFTER), check)


def warn_at_start(
    log: logging.Logger, instance: object, others: Sequence[tuple[str, object]], *, is_regrouped: bool = False
) -> None:
    """Log such mistakes of a node.

    Args:
        others: The full names and the instances of the other nodes of its process.
        is_regrouped: Whether a graph file changes its groups.
    """
    cls: type = type(instance)
    if not is_users_module(cls.__module__):
        return
    from graphflow.runtime.mistakes.source.slips import slips, slips_in_groups  # commands' own nodes need none of it

    found = slips(cls)
    if not is_regrouped:
        found = (*found, *slips_in_groups(cls))
    for slip in found:
        if not (slip.endswith(HIDDEN) and log.isEnabledFor(logging.DEBUG)):
            log.warning("%s", slip)
    if others:
        from graphflow.runtime.mistakes.source.shared_attributes import shared_attributes  # most are alone

        for text in shared_attributes(instance, others):
            log.warning("%s", text)
