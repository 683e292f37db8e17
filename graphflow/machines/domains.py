"""Nodes in other domains: where a domain is empty, its number is probably wrong."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable

from graphflow.names import is_hidden
from graphflow.wire.liveliness import Kind, parse_token

COMMANDS = "graphflow --domain {} ..."
"""How a command gets into another domain."""
SHOWN = 5
"""Domains that are named."""


def by_domain(tokens: Iterable[str], own: Collection[str] = ()) -> Counter[int]:
    """How many nodes each domain has; hidden ones do not count, nor do those of the names in `own`."""
    nodes = [e for e in map(parse_token, tokens) if e is not None and e.kind is Kind.NODE]
    return Counter(e.domain for e in nodes if not is_hidden(e.node_name) and e.node_name not in own)


def elsewhere(domain: int, tokens: Iterable[str], way: str, own: Collection[str] = ()) -> str:
    """Say that a domain has no nodes but those of the names in `own`, and which others have some.

    Args:
        tokens: Those of the nodes of all domains.
        way: What to do, with `{}` for the other domain.

    Returns:
        `this domain, 112, has no other nodes; domain 111 has 1: ...`; empty if it has some, or no other domain has.
    """
    nodes = by_domain(tokens, own)
    if domain in nodes or not nodes:
        return ""
    listing = ", ".join(f"domain {other} has {count}" for other, count in sorted(nodes.items())[:SHOWN])
    return f"this domain, {domain}, has no other nodes; {listing}: {way.format(min(nodes))}"
