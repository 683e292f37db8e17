"""Reasons why an announced server is unreachable: another definition, or a net profile between two machines."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

from graphflow.msgs import registry
from graphflow.runtime.part import Host
from graphflow.wire import net
from graphflow.wire.liveliness import Entity
from graphflow.wire.net import NetToken

ANSWER_LIMIT = 0.2
"""Seconds to wait for the net profiles in force on this machine's links."""


async def why_unreachable(host: Host, name: str, servers: Sequence[Entity], hash_: str) -> str:
    """Return the reason why servers of the right name and type are unreachable.

    Args:
        name: The service, or a service of an action.
        servers: The announced servers.
        hash_: The type hash of calls from here.
    """
    type_name = servers[0].type
    if all(server.hash != hash_ for server in servers):
        why = registry.why_different(type_name)
        return f"{name}: the server's {type_name} has a different definition from the one here{why}"
    profiles = await _profiles(host)
    if refusal := net.refusal(name, profiles):
        return refusal
    other = ", or the net profile of the other machine blocks calls" if profiles else ""
    return f"{name}: the server is announced but does not accept calls: its process is starting or stopping{other}"


async def _profiles(host: Host) -> list[NetToken]:
    """Return the net profiles in force on this machine."""
    found: list[NetToken] = []

    def tokens(text: str, alive: bool) -> None:
        if alive and (profile := net.parse(text)) is not None:
            found.append(profile)

    watch = host.context.session.watch(net.watch_key(host.context.domain), tokens)
    try:
        await asyncio.sleep(ANSWER_LIMIT)  # links answer in real time, whatever the node's clock
    finally:
        watch.close()
    return found
