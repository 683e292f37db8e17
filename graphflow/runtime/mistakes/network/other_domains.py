"""Nodes of this machine in other domains, when a node is alone in its own."""

from __future__ import annotations

from asyncio import Future
from collections.abc import Callable, Sequence

from graphflow.deadlock.protocols import ProcessContext
from graphflow.domain import domain_variable
from graphflow.machines.domains import COMMANDS, elsewhere, with_counterpart
from graphflow.names import is_hidden
from graphflow.wire.liveliness import ALL, NODES, Entity

ANSWER_LIMIT = 0.2
"""Seconds to wait for the rendezvous's list of nodes."""


def look_elsewhere(
    here: ProcessContext, node: str, report: Callable[[str], None], lacking: Sequence[Entity] = ()
) -> None:
    """Check whether a node is alone in its domain while other domains have nodes.

    Args:
        node: The node's full name.
        report: Called on the loop, possibly at once, with a sentence; "" if the node is not alone.
        lacking: Endpoints without a counterpart: only domains that have one count, since others are other people's.
    """
    if any(other != node for other in here.cache.nodes(hidden=False)):
        report("")
        return
    way = COMMANDS if is_hidden(node) else f"if that is yours, join it with {domain_variable()}={{}}"

    def answered(tokens: list[str]) -> None:
        among = with_counterpart(lacking, tokens) if lacking else None
        if here.domain and not is_hidden(node):  # two domains that were both chosen belong to two people
            among = {0} if among is None else among & {0}
        report(elsewhere(here.domain, tokens, way, (node,), among))

    here.session.ask_tokens(ALL if lacking else NODES, ANSWER_LIMIT, answered)


async def alone_here(here: ProcessContext, node: str) -> str:
    """Return `look_elsewhere`'s sentence, to be appended: `; this domain, 112, has no other nodes; ...`, or ""."""
    found: Future[str] = here.loop.create_future()
    look_elsewhere(here, node, lambda text: None if found.done() else found.set_result(text))
    text = await found
    return text and f"; {text}"
