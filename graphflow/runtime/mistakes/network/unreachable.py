"""Why a server that is announced cannot be reached: another definition, or a net profile between two machines."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

from graphflow.msgs import registry
from graphflow.runtime.part import Host
from graphflow.wire import net
from graphflow.wire.liveliness import Entity
from graphflow.wire.net import NetToken

TOLD_WITHIN = 0.2
"""Seconds in which the links of this machine say which net profiles are in force."""


async def why_unreachable(host: Host, name: str, servers: Sequence[Entity], hash_: str) -> str:
    """Why calls do not get to servers of the right name and type.

    Args:
        name: The service, or a part of an action.
        servers: What is announced.
        hash_: The definition that calls have here.
    """
    type_name = servers[0].type
    if all(server.hash != hash_ for server in servers):
        why = registry.why_different(type_name)
        return f"{name}: the server's {type_name} has a different definition from the one here{why}"
    profiles = await _profiles(host)
    if refusal := net.refusal(name, profiles):
        return refusal
    other = ", or the net profile of the other machine keeps calls back" if profiles else ""
    return f"{name}: the server is announced, but does not take calls: its process is starting, or about to end{other}"


async def _profiles(host: Host) -> list[NetToken]:
    """The net profiles that are in force on this machine."""
    found: list[NetToken] = []

    def told(text: str, alive: bool) -> None:
        if alive and (profile := net.parse(text)) is not None:
            found.append(profile)

    watch = host.context.session.watch(net.watch_key(host.context.domain), told)
    try:
        await asyncio.sleep(TOLD_WITHIN)  # links answer in real time, whatever the clock says
    finally:
        watch.close()
    return found
