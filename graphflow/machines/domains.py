"""Hints about other domains: a domain that is empty while others have nodes is probably the wrong number."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Container, Iterable

from graphflow.machines.matching import COUNTERPARTS
from graphflow.names import is_hidden
from graphflow.wire.liveliness import Entity, Kind, parse_token

COMMANDS = "graphflow --domain {} ..."
"""Remedy for a command: the same in another domain."""
SHOWN = 5
"""Domains that a hint names, at most."""


def by_domain(tokens: Iterable[str], own: Collection[str] = ()) -> Counter[int]:
    """Count the nodes of each domain, except hidden ones and those with a name in `own`."""
    nodes = [e for e in map(parse_token, tokens) if e is not None and e.kind is Kind.NODE]
    return Counter(e.domain for e in nodes if not is_hidden(e.node_name) and e.node_name not in own)


def remedy(way: str, domains: Collection[int]) -> str:
    """Return a remedy with the only other domain, or with `N` if there are several to choose from.

    Args:
        way: The remedy, with `{}` for the domain.
    """
    return way.format(*domains) if len(domains) == 1 else way.format("N")


def with_counterpart(lacking: Iterable[Entity], tokens: Iterable[str]) -> set[int]:
    """Return the domains that have a counterpart of one of these endpoints, of the same name and type."""
    wanted = {(COUNTERPARTS[own.kind], own.name, own.type) for own in lacking}
    return {e.domain for e in map(parse_token, tokens) if e is not None and (e.kind, e.name, e.type) in wanted}


def elsewhere(
    domain: int, tokens: Iterable[str], way: str, own: Collection[str] = (), among: Container[int] | None = None
) -> str:
    """Return a hint that a domain has no nodes except those in `own`, and which other domains have some.

    Args:
        tokens: The node tokens of all domains.
        way: The remedy, with `{}` for the other domain.
        among: The other domains that count; None for all.

    Returns:
        `this domain, 112, has no other nodes; domain 111 has 1: ...`; empty if it has nodes, or no other domain does.
    """
    nodes = by_domain(tokens, own)
    if among is not None:
        nodes = Counter({d: count for d, count in nodes.items() if d == domain or d in among})
    if domain in nodes or not nodes:
        return ""
    listing = ", ".join(f"domain {other} has {count}" for other, count in sorted(nodes.items())[:SHOWN])
    return f"this domain, {domain}, has no other nodes; {listing}: {remedy(way, nodes)}"
