"""Matching of endpoints: whether two that share a name reach each other, and the complaint if they do not.

Over Zenoh, delivery depends on the data key alone: name, type and the hash of its definition. The rest of the quality
of service is enforced by no Zenoh peer, but by every DDS one. ROS 2 reports neither mismatch, so both become complaints
here.

Source: rmw_zenoh graph_cache (matching by data key); OMG DDS 1.4, 2.2.3 (requested and offered).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from graphflow.machines.cache import ACTION_SEND_GOAL
from graphflow.names import is_hidden
from graphflow.qos import Qos, incompatible, on_offer
from graphflow.wire.liveliness import Entity, Kind
from graphflow.wire.profile import PROFILES, advice

COUNTERPARTS = {
    Kind.PUBLISHER: Kind.SUBSCRIPTION,
    Kind.SUBSCRIPTION: Kind.PUBLISHER,
    Kind.SERVICE: Kind.CLIENT,
    Kind.CLIENT: Kind.SERVICE,
}
_WORDS = {
    Kind.PUBLISHER: "publisher",
    Kind.SUBSCRIPTION: "subscription",
    Kind.SERVICE: "server",
    Kind.CLIENT: "client",
}
SHARED_SHOWN = 4
"""Services, and nodes that share them, that a complaint names, at most."""


class Verdict(NamedTuple):
    """The result of matching an endpoint with a counterpart of the same name."""

    reaches: bool
    """Whether messages that one of them sends arrive at the other."""
    policies: tuple[str, ...] = ()
    """Policies that are incompatible over DDS."""
    complaint: str = ""
    """Sentence with the problem and the remedy; empty if there is none."""


def verdict(own: Entity, other: Entity, profile: str = PROFILES[0], where: str = "here") -> Verdict | None:
    """Match two endpoints; None if they are not counterparts of the same name.

    Args:
        profile: The wire profile of this process.
        where: The phrase by which the complaint locates `own`.
    """
    if other.name != own.name or other.kind is not COUNTERPARTS.get(own.kind):
        return None
    who, what = f"the {_WORDS[other.kind]} of {other.node_name}", f"the {_WORDS[own.kind]} {where}"
    if other.type != own.type:
        remedy = advice(other, profile) or "give both the same type, or rename one of them"
        return Verdict(
            False,
            complaint=f"{own.name}: nothing passes between {who}, of type {other.type}, and {what}, of type "
            f"{own.type}: {remedy}",
        )
    if other.hash != own.hash:
        remedy = advice(other, profile) or "use the same definition file on both sides, and start the older one again"
        return Verdict(
            False,
            complaint=f"{own.name}: nothing passes between {who} and {what}: they have different definitions of "
            f"{own.type} ({_short(other.hash)} there, {_short(own.hash)} here): {remedy}",
        )
    if own.kind not in (Kind.PUBLISHER, Kind.SUBSCRIPTION):
        return Verdict(True)
    offered, requested = (own, other) if own.kind is Kind.PUBLISHER else (other, own)
    policies = tuple(incompatible(offered.qos, requested.qos))
    if not policies:
        return Verdict(True)
    return Verdict(
        True,
        policies,
        f"{own.name}: the publisher of {offered.node_name} offers less than the subscription of "
        f"{requested.node_name} asks for: {', '.join(policies)}. {_remedy(offered.qos, policies)}",
    )


def _remedy(offered: Qos, policies: Sequence[str]) -> str:
    """Return the effect of incompatible policies, and the change that ends it."""
    weaker = on_offer(offered, [policy for policy in policies if policy != "durability"])
    if "durability" not in policies:
        return f"Over Zenoh messages pass; over DDS none would: have the subscription ask for {weaker}"
    # A subscription that asks for TRANSIENT_LOCAL needs earlier messages: asking for less would only silence this.
    also = f", and the subscription ask for {weaker}" if weaker else ""
    return (
        "Over Zenoh messages pass, but not those published before the subscription opened; over DDS none would: have "
        f"the publisher offer durability TRANSIENT_LOCAL{also}"
    )


def complaints(entities: Iterable[Entity], profile: str = PROFILES[0]) -> list[str]:
    """Return the complaints about all pairs of endpoints in a graph."""
    by_name: dict[str, list[Entity]] = {}
    for entity in entities:
        if entity.kind in COUNTERPARTS:
            by_name.setdefault(entity.name, []).append(entity)
    found: dict[str, None] = {}
    for same in by_name.values():
        for own in same:
            for other in same:
                if own.kind in (Kind.SUBSCRIPTION, Kind.CLIENT):
                    judged = verdict(own, other, profile, f"of {own.node_name}")
                    if judged is not None and judged.complaint:
                        found[judged.complaint] = None
    return list(found)


def shared(entities: Iterable[Entity]) -> list[str]:
    """Return complaints about services and actions that several nodes offer, one for each set of nodes."""
    nodes: dict[str, set[str]] = {}
    for entity in entities:
        name = entity.name.removesuffix(ACTION_SEND_GOAL)
        if entity.kind is Kind.SERVICE and not is_hidden(name):
            nodes.setdefault(name, set()).add(entity.node_name)
    names: dict[tuple[str, ...], list[str]] = {}
    for name in sorted(nodes):
        if len(nodes[name]) > 1:
            names.setdefault(tuple(sorted(nodes[name])), []).append(name)
    return [_sharing(who, what) for who, what in names.items()]


def _sharing(nodes: Sequence[str], names: Sequence[str]) -> str:
    is_one = len(names) == 1
    first = ", ".join(names[:SHARED_SHOWN]) + (f" and {len(names) - SHARED_SHOWN} more" * (len(names) > SHARED_SHOWN))
    shown = nodes if len(nodes) <= SHARED_SHOWN else [*nodes[:SHARED_SHOWN], f"{len(nodes) - SHARED_SHOWN} more"]
    way = (
        f"remap one: --ros-args -r {names[0].rpartition('/')[2]}:=NAME, or -r" if is_one else "move one: --ros-args -r"
    )
    return (
        f"{first} {'is' if is_one else 'are'} offered by {', '.join(shown[:-1])} and {shown[-1]}: each call reaches "
        f"all of them; {way} __ns:=/NAMESPACE"
    )


def _short(hash_: str) -> str:
    return hash_[:15]
