"""Nodes of this machine in other domains, where a node is alone in its own."""

from __future__ import annotations

from asyncio import Future
from collections.abc import Callable

from graphflow.deadlock.protocols import ProcessContext
from graphflow.domain import domain_variable
from graphflow.machines.domains import COMMANDS, elsewhere
from graphflow.names import is_hidden
from graphflow.wire.liveliness import NODES

TOLD_WITHIN = 0.2
"""Seconds in which the rendezvous says which nodes there are."""


def look_elsewhere(here: ProcessContext, node: str, told: Callable[[str], None]) -> None:
    """Find out whether a node is alone in its domain while others have nodes.

    Args:
        node: Its full name.
        told: Called on the loop with a sentence; empty if it is not so. Perhaps at once.
    """
    if any(other != node for other in here.cache.nodes(hidden=False)):
        told("")
        return
    way = COMMANDS if is_hidden(node) else f"start it with {domain_variable()}={{}} to join"
    here.session.ask_tokens(NODES, TOLD_WITHIN, lambda tokens: told(elsewhere(here.domain, tokens, way, (node,))))


async def alone_here(here: ProcessContext, node: str) -> str:
    """As `look_elsewhere`: `; this domain, 112, has no other nodes; ...`, for the end of a sentence, or nothing."""
    found: Future[str] = here.loop.create_future()
    look_elsewhere(here, node, lambda text: None if found.done() else found.set_result(text))
    text = await found
    return text and f"; {text}"
