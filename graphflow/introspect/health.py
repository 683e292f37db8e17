"""Faults of a graph besides its waits: nodes that share a name or offer the same service, hear themselves,
lose messages, log in floods, or listen where nobody speaks; remaps that match nothing; clocks that differ.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from graphflow.introspect.graph_view import View
from graphflow.introspect.numbers import REPLY_BOUND
from graphflow.machines.cache import GraphCache
from graphflow.machines.matching import shared
from graphflow.machines.near_topics import EVERYBODYS, is_misspelt
from graphflow.names import is_hidden, nearest
from graphflow.system import host_name
from graphflow.wire.liveliness import Entity, Kind
from graphflow.wire.process import ProcessToken

FLOOD = 50.0
"""Lines a second from which on a log is a flood."""
ECHO = 1.0
"""Messages a second that a node hears of itself, from which on that is told."""
LOST_PART, LOST_LEAST = 0.5, 20
"""Part of the messages, and number of them, from which on the loss is told."""
TOLD_BOUND = 10
"""Nodes, or texts of one node, that are told."""
SKEW = 0.1
"""Seconds by which clocks differ, beyond the time of the answer, from which on that is told."""

Counts = Mapping[tuple[str, str], Mapping[str, float]]
"""What each part of each node has counted: by node and part."""


class Health(NamedTuple):
    """Faults and notes."""

    faults: list[str]
    hints: list[str]
    """What may be meant to be so."""


class Look(NamedTuple):
    """What the processes of a domain have counted."""

    replies: list[bytes]
    began_ns: int
    """When they were asked, nanoseconds since 1970 by the clock of this machine."""
    ended_ns: int
    """When all had answered."""
    at: float
    """When they were asked, in seconds by a clock that only goes forward."""


def needs_second(view: View, first: Look) -> bool:
    """Whether one look does not tell all: nodes may hear themselves, or do not say how much they log a second."""
    logs = [numbers for (_, part), numbers in read(first.replies).items() if part == "log"]
    return any(_own_topics(view.cache)) or any("rate" not in numbers for numbers in logs)


def examine(view: View, first: Look, second: Look) -> Health:
    """What is wrong, by two looks at what the processes have counted, or one and the same where that is enough."""
    before, now, seconds = first.replies, second.replies, second.at - first.at or 1.0
    then, counts = read(before), read(now)
    faults = [
        *_twins(view),
        *shared(view.cache),
        *_echoes(view.cache, then, counts, seconds),
        *_losses(counts),
        *_floods(then, counts, seconds),
        *_refused(view.cache),
        *_complaints(now),
        *_skews(view.processes(), second),
    ]
    near, far = _unheard(view.cache)
    return Health([*faults, *near], [*far, *_strangers(view)])


def read(replies: Iterable[bytes]) -> Counts:
    """The numbers of all processes; what cannot be read is left out."""
    found: dict[tuple[str, str], dict[str, float]] = {}
    for reply in replies:
        try:
            data: Any = json.loads(reply) if len(reply) <= REPLY_BOUND else {}
            for node, parts in dict(data["nodes"]).items():
                for part, numbers in dict(parts).items():
                    kept = {str(k): float(n) for k, n in dict(numbers).items() if isinstance(n, (int, float))}
                    found[str(node), str(part)] = kept
        except (ValueError, KeyError, TypeError, OverflowError, RecursionError):
            continue
    return found


def _twins(view: View) -> Iterator[str]:
    """Nodes of one name: ROS 2's tools and parameters reach one of them, by chance."""
    for name, count in Counter(view.cache.nodes(hidden=False)).items():
        if count > 1:
            yield f"{count} nodes are called {name} ({view.owner(name)}, among others): rename all but one"


def _echoes(cache: GraphCache, then: Counts, now: Counts, seconds: float) -> Iterator[str]:
    """Nodes that hear what they say."""
    for entity in _own_topics(cache):
        rate = _rate(then, now, (entity.node_name, f"subscription {entity.name}"), ("received",), seconds)
        said = _rate(then, now, (entity.node_name, f"publisher {entity.name}"), ("published",), seconds)
        if min(rate, said) >= ECHO:
            yield (
                f"{entity.node_name} hears what it says itself on {entity.name}, {rate:.0f} messages a second: remap "
                "one of the two, or subscribe with ignore_local=True"
            )


def _own_topics(cache: GraphCache) -> Iterator[Entity]:
    """Subscriptions of topics that their own node publishes."""
    spoken = {(e.node_name, e.name, e.type) for e in cache.endpoints(Kind.PUBLISHER)}
    for entity in cache.endpoints(Kind.SUBSCRIPTION):
        if (entity.node_name, entity.name, entity.type) in spoken and entity.name not in EVERYBODYS:
            yield entity


def _losses(now: Counts) -> Iterator[str]:
    for (node, part), numbers in now.items():
        received, dropped = numbers.get("received", 0.0), numbers.get("dropped", 0.0)
        if received and dropped >= max(LOST_LEAST, LOST_PART * received):
            yield (
                f"{part} of {node} has lost {100 * dropped / received:.0f} % of {received:.0f} messages: its handler "
                "is slower than they come, or waits for a group; do less in it, or have less sent"
            )


def _floods(then: Counts, now: Counts, seconds: float) -> Iterator[str]:
    for node, part in now:
        if part == "log":
            told = now[node, part].get("rate")
            rate = _rate(then, now, (node, part), ("lines", "gathered"), seconds) if told is None else told
            if rate >= FLOOD:
                yield f"{node} logs {rate:.0f} lines a second: say throttle=1.0 where it does"


def _refused(cache: GraphCache) -> Iterator[str]:
    if cache.refused:
        yield (
            f"{cache.refused} announcements of nodes or endpoints are malformed and were left out; some process here "
            "speaks another protocol, or means harm"
        )


def _complaints(replies: Iterable[bytes]) -> Iterator[str]:
    """What nodes know to be wrong with themselves."""
    for data in map(_told, replies):
        found = data.get("complaints")
        for node, texts in list(found.items())[:TOLD_BOUND] if isinstance(found, dict) else ():
            for text in texts[:TOLD_BOUND] if isinstance(texts, list) else ():
                yield f"{node}: {text}"


def _skews(processes: Mapping[str, ProcessToken], look: Look) -> Iterator[str]:
    """Machines whose clocks tell another time than this one's, by more than the time in which they answered."""
    found: dict[str, float] = {}
    for data in map(_told, look.replies):
        token, time_ns = processes.get(str(data.get("process"))), data.get("time_ns")
        if token is None or token.host == host_name() or type(time_ns) is not int:
            continue
        if not 0 < time_ns < 1 << 63:
            continue
        ahead = max(0, time_ns - look.ended_ns) + min(0, time_ns - look.began_ns)
        if abs(ahead) >= SKEW * 1e9:
            found[token.host] = ahead / 1e9
    for host, seconds in sorted(found.items()):
        where = "ahead of" if seconds > 0 else "behind"
        yield (
            f"the clock of {host} is {abs(seconds):.1f} s {where} this machine's: stamps and transforms do not fit "
            "together; have both set by NTP (timedatectl set-ntp true)"
        )


def _strangers(view: View) -> Iterator[str]:
    """Nodes of other machines."""
    here, tokens = host_name(), view.processes()
    for host in sorted({token.host for token in tokens.values()} - {here}):
        zids = {zid for zid, token in tokens.items() if token.host == host}
        nodes = sorted({e.node_name for e in view.cache if e.zid in zids and not is_hidden(e.node_name)})
        if nodes:
            more = f" and {len(nodes) - TOLD_BOUND} more" if len(nodes) > TOLD_BOUND else ""
            yield f"{', '.join(nodes[:TOLD_BOUND])}{more} on another machine, {host}"


def _told(reply: bytes) -> dict[str, Any]:
    """What a process has told; nothing, where it cannot be read."""
    try:
        data = json.loads(reply) if len(reply) <= REPLY_BOUND else {}
    except (ValueError, RecursionError):
        return {}
    return data if isinstance(data, dict) else {}


def _unheard(cache: GraphCache) -> tuple[list[str], list[str]]:
    """Topics that are listened to and never published, and services that are called and never offered.

    Returns:
        Those that are probably misspelt, and the others.
    """
    near: list[str] = []
    far: list[str] = []
    for here, there, verbs, speaks in (
        (Kind.SUBSCRIPTION, Kind.PUBLISHER, ("listens to", "listen to"), "publishes"),
        (Kind.CLIENT, Kind.SERVICE, ("calls", "call"), "offers"),
    ):
        offered = {e.name for e in cache.endpoints(there) if not is_hidden(e.name)}
        for name in sorted({e.name for e in cache.endpoints(here)} - offered):
            who = sorted({e.node_name for e in cache.endpoints(here, name) if not is_hidden(e.node_name)})
            if not who or is_hidden(name) or name in EVERYBODYS:
                continue
            text = f"{' and '.join(who)} {verbs[len(who) > 1]} {name}, which nobody {speaks}"
            best = next((other for other in sorted(offered) if is_misspelt(name, other)), "")
            if best:
                near.append(f"{text}; did you mean {best}?")
            else:
                far.append(f"{text}{_nearest(cache, name, here, there)}")
    return near, far


def _nearest(cache: GraphCache, name: str, here: Kind, there: Kind) -> str:
    """Names on offer instead of one that nobody offers: the most similar, else those of its type."""
    type_ = {e.type for e in cache.endpoints(here, name)}
    same = sorted({e.name for e in cache.endpoints(there) if e.type in type_ and not is_hidden(e.name)} - {*EVERYBODYS})
    like = nearest(name, same)
    of_its_type = [like] if like else same[:TOLD_BOUND]
    return f"; of that type there is {', '.join(of_its_type)}" if of_its_type else ""


def _rate(then: Counts, now: Counts, key: tuple[str, str], words: tuple[str, ...], seconds: float) -> float:
    """What was added in a second."""
    if key not in then or key not in now:
        return 0.0
    return sum(now[key].get(word, 0.0) - then[key].get(word, 0.0) for word in words) / seconds
