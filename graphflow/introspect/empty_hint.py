"""Hints for an empty listing, and for topics without messages: other domains, net profiles, inactive publishers."""

from __future__ import annotations

from collections.abc import Iterable

from graphflow.domain import domain_id
from graphflow.introspect.graph_view import View
from graphflow.introspect.lifecycles import idle
from graphflow.machines.domains import COMMANDS, SHOWN, by_domain, remedy
from graphflow.transport.client import Client
from graphflow.wire.liveliness import NODES, Kind

ANSWER_LIMIT = 1.0
"""Seconds that a lifecycle node has to tell its state."""


def nothing_here(what: str) -> str:
    """Return `no nodes in domain 5; there are 3 nodes in domain 0: graphflow --domain 0 ...`.

    Args:
        what: The missing things, such as `no topics`.
    """
    here = domain_id()
    client = Client()
    try:
        others = by_domain(client.tokens(NODES))
    finally:
        client.close()
    del others[here]
    if not others:
        return f"{what} in domain {here}, and none in others"
    counts = sorted(others.items())[:SHOWN]
    is_one = counts[0][1] == 1
    listing = ", ".join(f"{n} node{'s' if n > 1 else ''} in domain {d}" for d, n in counts)
    return f"{what} in domain {here}; there {'is' if is_one else 'are'} {listing}: {remedy(COMMANDS, others)}"


def why_silent(topics: Iterable[str]) -> str:
    """Describe what may keep the messages of one of some topics from this machine; empty if nothing is known to.

    It is a net profile, or a publisher's lifecycle node that is not active.
    """
    with View(domain_id()) as view:
        for topic in topics:
            if text := view.why_silent(topic):
                return text
            publishers = {e.node_name for e in view.cache.endpoints(Kind.PUBLISHER, topic)}
            if hints := idle(view, ANSWER_LIMIT, publishers).hints:
                return hints[0]
    return ""
