"""Suggestions for topics without a counterpart: another topic of the same type and a similar name."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from itertools import islice

from graphflow.machines.matching import COUNTERPARTS
from graphflow.names import MAX_LENGTH, is_everybodys, is_hidden, nearest, without_slash
from graphflow.wire.liveliness import Entity, Kind

CUTOFF = 0.75
"""Least similarity (0 to 1) of two words of which one may be the other misspelt."""
COMPARED = 500
"""Names that one is compared with, at most: other processes announce any number, and each takes up to 0.1 ms."""

_DIGITS = "0123456789"
_OF_SENSORS = ("sensor_msgs/", "nav_msgs/")

ByType = Mapping[tuple[Kind, str], list[Entity]]
"""Endpoints by kind and type."""


def by_type(entities: Iterable[Entity], types: Container[str]) -> ByType:
    """Group the endpoints of users' topics of some types by kind and type."""
    found: dict[tuple[Kind, str], list[Entity]] = {}
    for entity in entities:
        if entity.type not in types or entity.kind not in (Kind.PUBLISHER, Kind.SUBSCRIPTION):
            continue
        if len(entity.name) <= MAX_LENGTH and not is_everybodys(entity.name):
            found.setdefault((entity.kind, entity.type), []).append(entity)
    return found


def did_you_mean_topic(own: Entity, there: ByType) -> str:
    """Return a message that an endpoint has no counterpart, and the topic that was probably meant.

    Returns:
        Empty if it has a counterpart, or no topic is similar.
    """
    kind = COUNTERPARTS[own.kind]
    others = there.get((kind, own.type), ())
    if any(other.name == own.name for other in others):
        return ""
    used = {e.name for k in (own.kind, kind) for e in there.get((k, own.type), ()) if _is_of_one_node(e, own)}
    # In order of arrival, so that a flood of new names cannot push out those that were known before.
    met = {e.name for e in there.get((own.kind, own.type), ())}
    used -= {name for name in used - met if is_misspelt(own.name, name)}  # the node's own other end is misspelt
    names = dict.fromkeys(e.name for e in others if e.name not in used and not is_hidden(e.node_name))
    near = [name for name in islice(names, COMPARED) if is_near(own.name, name)]
    within = own.namespace + own.name
    best = within if within in near else nearest(own.name, sorted(near), cutoff=0.0)
    if best is None:
        return _only_one_of_type(own, names) or _only_two_apart(own, there)
    first, *more = sorted({e.node_name for e in others if e.name == best and not is_hidden(e.node_name)})
    who = f"{first} and {len(more)} more" if more else first
    if own.kind is Kind.PUBLISHER:
        verbs, end = "listens to", f"to which {who} listen{'' if more else 's'}"
    else:
        verbs, end = "publishes", f"which {who} publish{'' if more else 'es'}"
    return f"nobody {verbs} {own.name} [{own.type}]; did you mean {best!r}, {end}?{_slash(own, best, others)}"


def _slash(own: Entity, best: str, others: Iterable[Entity]) -> str:
    """Return the remedy if one of the two ends has a slash that keeps its namespace out; else empty."""
    if best == own.namespace + own.name:
        return f" Write {without_slash(own.name)}."
    alike = sorted(e.node_name for e in others if e.name == best and own.name == e.namespace + e.name)
    return f" In {alike[0]} write {without_slash(best)}." if alike else ""


def _only_one_of_type(own: Entity, names: Iterable[str]) -> str:
    """Return a message that a subscription's topic has no publisher, while one with an added word has: the only one.

    Words are added on purpose, too, as in `cmd_vel_nav`; for the only sensor of its type, it is more likely a slip.
    """
    only = list(islice(names, 2))
    if own.kind is not Kind.SUBSCRIPTION or len(only) != 1 or not own.type.startswith(_OF_SENSORS):
        return ""
    *place, last = own.name.split("/")
    *other_place, other_last = only[0].split("/")
    ours, theirs = {*last.split("_")}, {*other_last.split("_")}
    if place != other_place or not (ours > theirs or theirs > ours):
        return ""
    return f"nobody publishes {own.name} [{own.type}]; the only topic of this type is {only[0]!r}"


def _only_two_apart(own: Entity, there: ByType) -> str:
    """Return a message that a subscription has no publisher, while the only other topic with one end has no listener.

    Both may be meant so; for the only two of a type, whose names have no word in common, it is likely that they come
    from two examples.
    """
    heard = [e for e in there.get((Kind.SUBSCRIPTION, own.type), ()) if not is_hidden(e.node_name)]
    sent = [e for e in there.get((Kind.PUBLISHER, own.type), ()) if not is_hidden(e.node_name)]
    apart = {e.name for e in (*heard, *sent)} - ({e.name for e in heard} & {e.name for e in sent})
    other = next((e for e in sent if e.name in apart and not _is_of_one_node(e, own)), None)
    if own.kind is not Kind.SUBSCRIPTION or len(apart) != 2 or other is None or _words(own.name) & _words(other.name):
        return ""
    text = f"nobody publishes {own.name} [{own.type}], and nobody listens to {other.name} of {other.node_name}"
    return f"{text}: if they belong together, give them one name"


def _words(name: str) -> set[str]:
    return {word for part in name.split("/") for word in part.split("_") if word}


def of_other_kind(own: Entity, named: Iterable[Entity]) -> str:
    """Return a message that a topic's name is that of a service, or the reverse.

    Args:
        named: The endpoints of that name, of any kind.
    """
    is_topic = own.kind in (Kind.PUBLISHER, Kind.SUBSCRIPTION)
    if any(other.kind is COUNTERPARTS[own.kind] for other in named):
        return ""
    for other in named:
        if is_topic and other.kind is Kind.SERVICE:
            return f"{own.name} is a service of {other.node_name} and not a topic: call it with a client"
        if own.kind is Kind.CLIENT and other.kind in (Kind.PUBLISHER, Kind.SUBSCRIPTION):
            return f"{own.name} is a topic of {other.node_name} and not a service: use a publisher or a subscription"
    return ""


def _is_of_one_node(entity: Entity, other: Entity) -> bool:
    return (entity.zid, entity.nid) == (other.zid, other.nid)


def is_near(name: str, other: str) -> bool:
    """Whether one name may be meant for the other: misspelt, in other case, or with a namespace missing or added."""
    return (
        name.casefold() == other.casefold() or name.endswith(other) or other.endswith(name) or is_misspelt(name, other)
    )


def is_misspelt(name: str, other: str) -> bool:
    """Whether two names differ in one part, by a few letters. Numbers, single letters and added words are no mistakes.

    So `cmd_vl` is `cmd_vel`, while `cmd_vel_nav` is another topic, as `turtle2` and `goal_b` are.
    """
    ours, theirs = name.split("/"), other.split("/")
    apart = [pair for pair in zip(ours, theirs, strict=False) if pair[0] != pair[1]]
    if len(ours) != len(theirs) or len(apart) != 1:
        return False
    [(a, b)] = apart
    if a.strip(_DIGITS) == b.strip(_DIGITS):
        return a[-1:].isdigit() is not b[-1:].isdigit()  # `turtle` for `turtle1`; `turtle2` is another one
    if _is_another(a.split("_"), b.split("_")):
        return False
    return nearest(a, [b], cutoff=CUTOFF) is not None


def _is_another(ours: Sequence[str], theirs: Sequence[str]) -> bool:
    """Whether two names differ on purpose: words are added, or a single letter differs, as in `axis_x`, `axis_y`."""
    if len(ours) != len(theirs):
        return {*ours} >= {*theirs} or {*theirs} >= {*ours}
    return all(a == b or len(a) == len(b) == 1 for a, b in zip(ours, theirs, strict=True))
