"""Faults of a graph other than its waits: nodes that share a name or a service, receive their own messages, lose
messages, flood their logs, or subscribe to topics without publishers; remap rules that match nothing; clock skews.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from graphflow.introspect.graph_view import View
from graphflow.introspect.numbers import REPLY_BOUND
from graphflow.machines.cache import ACTION_SEND_GOAL, GraphCache
from graphflow.machines.matching import shared
from graphflow.machines.near_topics import is_misspelt
from graphflow.names import EVERYBODYS, is_hidden, nearest
from graphflow.qos import History
from graphflow.system import host_name
from graphflow.wire.liveliness import Entity, Kind
from graphflow.wire.process import ProcessToken

FLOOD = 50.0
"""Log lines per second from which a flood is reported."""
ECHO, ECHO_LEAST = 1.0, 3
"""Own messages that a node receives, per second and in all, from which an echo is reported."""
LOST_PART, LOST_LEAST, EXPIRED_LEAST = 0.5, 20, 5
"""Share and number of dropped messages from which a loss is reported."""
MISSED_LEAST = 3
"""Missed deadlines or leases of an endpoint from which they are reported."""
RAISED_PART, REFUSED_PART = 0.1, 0.5
"""Shares of runs that raise from which a handler, and a service that may refuse requests so, are reported."""
CLOCK = "/clock"
SHOWN = 10
"""Most nodes in a list, or texts of one node."""
SKEW = 0.1
"""Seconds between two clocks, beyond the time of the answer, from which a skew is reported."""

Counts = Mapping[tuple[str, str], Mapping[str, float]]
"""Counters by node and part of the node."""


class Health(NamedTuple):
    """Faults and hints of a graph."""

    faults: list[str]
    hints: list[str]
    """Findings that may be intended."""


class Look(NamedTuple):
    """A sample of the counters of a domain's processes."""

    replies: list[bytes]
    began_ns: int
    """Time of the query, in nanoseconds since 1970 on this machine's clock."""
    ended_ns: int
    """Time of the last answer."""
    at: float
    """Time of the query, in seconds on the monotonic clock."""


def needs_second(view: View, first: Look) -> bool:
    """Whether rates must be measured: nodes may receive their own messages, or do not report their logging rate."""
    logs = [numbers for (_, part), numbers in read(first.replies).items() if part == "log"]
    return any(_own_topics(view.cache)) or any("rate" not in numbers for numbers in logs)


def examine(view: View, first: Look, second: Look) -> Health:
    """Find faults by two samples of the counters; they may be the same if `needs_second` is False."""
    before, now, seconds = first.replies, second.replies, second.at - first.at or 1.0
    then, counts = read(before), read(now)
    faults = [
        *_twins(view),
        *shared(view.cache),
        *_rivals(view.cache),
        *_echoes(view.cache, then, counts, seconds),
        *_losses(view.cache, counts),
        *_missed(counts),
        *_raising(counts),
        *_floods(then, counts, seconds),
        *_refused(view.cache),
        *_complaints(now),
        *_skews(view.processes(), second),
    ]
    near, far = _unheard(view.cache)
    return Health([*faults, *near], [*far, *_on_system_time(view.cache), *_strangers(view)])


def read(replies: Iterable[bytes]) -> Counts:
    """Read the counters of all processes; unreadable answers are left out."""
    found: dict[tuple[str, str], dict[str, float]] = {}
    for reply in replies:
        try:
            data = json.loads(reply) if len(reply) <= REPLY_BOUND else {}
            for node, parts in dict(data["nodes"]).items():
                for part, numbers in dict(parts).items():
                    kept = {str(k): float(n) for k, n in dict(numbers).items() if isinstance(n, (int, float))}
                    found[str(node), str(part)] = kept
        except (ValueError, KeyError, TypeError, OverflowError, RecursionError):
            continue
    return found


def _twins(view: View) -> Iterator[str]:
    """Report nodes that share a name, of which ROS 2's tools reach one at random."""
    for name, count in Counter(view.cache.nodes(hidden=False)).items():
        if count > 1:
            yield f"{count} nodes are called {name} ({view.owner(name)}, among others): rename all but one"


def _rivals(cache: GraphCache) -> Iterator[str]:
    """Report several nodes that steer one robot, which obeys the latest message, or that set one time."""
    for name, types in sorted(cache.topics().items()):
        effects = {effect for type_, effect in _EFFECTS.items() if type_ in types}
        nodes = sorted({e.node_name for e in cache.endpoints(Kind.PUBLISHER, name) if not is_hidden(e.node_name)})
        if effects and len(nodes) > 1:
            several = " and ".join(nodes[:SHOWN])
            yield f"{several} all publish {name}, and {effects.pop()}: stop all but one, or remap"


_EFFECTS = {
    "geometry_msgs/msg/Twist": "the robot obeys the latest",
    "geometry_msgs/msg/TwistStamped": "the robot obeys the latest",
    "rosgraph_msgs/msg/Clock": "the time jumps between theirs",
}
"""The effects of several publishers on one topic, by its type."""


def _echoes(cache: GraphCache, then: Counts, now: Counts, seconds: float) -> Iterator[str]:
    """Report nodes that receive their own messages."""
    for entity in _own_topics(cache):
        rate = _rate(then, now, (entity.node_name, f"subscription {entity.name}"), ("received",), seconds)
        published = _rate(then, now, (entity.node_name, f"publisher {entity.name}"), ("published",), seconds)
        if min(rate, published) >= max(ECHO, ECHO_LEAST / seconds):
            yield (
                f"{entity.node_name} receives its own messages on {entity.name}, {rate:.0f} per second: remap "
                "one of the two, or ignore them: a native node with ignore_local=True, one of rclpy in its callback"
            )


def _own_topics(cache: GraphCache) -> Iterator[Entity]:
    """Yield subscriptions to topics that their own node publishes."""
    published = {(e.node_name, e.name, e.type) for e in cache.endpoints(Kind.PUBLISHER)}
    for entity in cache.endpoints(Kind.SUBSCRIPTION):
        if (entity.node_name, entity.name, entity.type) in published and entity.name not in EVERYBODYS:
            yield entity


def _losses(cache: GraphCache, now: Counts) -> Iterator[str]:
    short = (e for e in cache.endpoints(Kind.SUBSCRIPTION) if e.qos.depth == 1 and e.qos.history is History.KEEP_LAST)
    newest = {(e.node_name, f"subscription {e.name}") for e in short}
    for (node, part), numbers in now.items():
        received, dropped = numbers.get("received", 0.0), numbers.get("dropped", 0.0)
        dropped = 0.0 if (node, part) in newest else dropped  # it keeps the newest message on purpose
        if received and dropped >= max(LOST_LEAST, LOST_PART * received):
            yield (
                f"{part} of {node} has lost {100 * dropped / received:.0f} % of {received:.0f} messages: its handler "
                "is too slow, or waits for a group; do less in it, or publish less"
            )
        expired = numbers.get("expired", 0.0)
        if received and expired >= max(EXPIRED_LEAST, LOST_PART * received):
            yield (
                f"{part} of {node} drops {100 * expired / received:.0f} % of its messages, which are older than their "
                "lifespan when they arrive: give it a longer lifespan"
            )


def _missed(now: Counts) -> Iterator[str]:
    """Report endpoints that do not keep what their own QoS profile promises, or get what it demands."""
    for (node, part), numbers in now.items():
        if (count := numbers.get("deadline_missed", 0.0)) >= MISSED_LEAST:
            yield f"{part} of {node} has missed its deadline {count:.0f} times: have more sent, or allow more time"
        if (count := numbers.get("liveliness_lost", 0.0)) >= MISSED_LEAST:
            yield (
                f"{part} of {node} has lost its liveliness {count:.0f} times: publish or assert_liveliness() within "
                "its lease"
            )


def _raising(now: Counts) -> Iterator[str]:
    """Report handlers that fail often, but not so often that their node ends."""
    for (node, part), numbers in now.items():
        runs, errors = numbers.get("runs", 0.0), numbers.get("errors", 0.0)
        share = REFUSED_PART if part.startswith("service ") else RAISED_PART
        if errors >= max(1.0, share * runs):
            yield f"{part} of {node} has raised in {errors:.0f} of {runs:.0f} runs: its log has the error and the line"


def _floods(then: Counts, now: Counts, seconds: float) -> Iterator[str]:
    for node, part in now:
        if part == "log":
            reported = now[node, part].get("rate")
            rate = _rate(then, now, (node, part), ("lines", "gathered"), seconds) if reported is None else reported
            if rate >= FLOOD:
                way = "throttle=1.0, in rclpy throttle_duration_sec=1.0"
                yield f"{node} logs {rate:.0f} lines per second: limit them with {way}"


def _refused(cache: GraphCache) -> Iterator[str]:
    if cache.refused:
        yield (
            f"{cache.refused} announcements of nodes or endpoints are malformed and were left out; some process here "
            "uses another protocol, or is malicious"
        )


def _complaints(replies: Iterable[bytes]) -> Iterator[str]:
    """Yield the faults that nodes report about themselves."""
    for data in map(_answer, replies):
        found = data.get("complaints")
        for node, texts in list(found.items())[:SHOWN] if isinstance(found, dict) else ():
            for text in texts[:SHOWN] if isinstance(texts, list) else ():
                yield f"{node}: {text}"


def _skews(processes: Mapping[str, ProcessToken], look: Look) -> Iterator[str]:
    """Report machines whose clocks differ from this one's by more than the time of the answer explains."""
    found: dict[str, float] = {}
    for data in map(_answer, look.replies):
        token, time_ns = processes.get(str(data.get("process"))), data.get("time_ns")
        if token is None or token.host == host_name() or type(time_ns) is not int:
            continue
        if not 0 < time_ns < 1 << 63:
            continue
        # The answer was made between query and last answer: only a time outside that span proves a skew.
        ahead = max(0, time_ns - look.ended_ns) + min(0, time_ns - look.began_ns)
        if abs(ahead) >= SKEW * 1e9:
            found[token.host] = ahead / 1e9
    for host, seconds in sorted(found.items()):
        where = "ahead of" if seconds > 0 else "behind"
        yield (
            f"the clock of {host} is {abs(seconds):.1f} s {where} this machine's: stamps and transforms do not match; "
            "synchronize both by NTP (timedatectl set-ntp true)"
        )


def _strangers(view: View) -> Iterator[str]:
    """Report nodes of other machines."""
    here, tokens = host_name(), view.processes()
    for host in sorted({token.host for token in tokens.values()} - {here}):
        zids = {zid for zid, token in tokens.items() if token.host == host}
        nodes = sorted({e.node_name for e in view.cache if e.zid in zids and not is_hidden(e.node_name)})
        if nodes:
            more = f" and {len(nodes) - SHOWN} more" if len(nodes) > SHOWN else ""
            yield f"{', '.join(nodes[:SHOWN])}{more} on another machine, {host}"


def _on_system_time(cache: GraphCache) -> Iterator[str]:
    """Yield the nodes that do not follow a simulated time, beside the one that publishes it."""
    simulators, followers = (
        {e.node_name for e in cache.endpoints(kind, CLOCK)} for kind in (Kind.PUBLISHER, Kind.SUBSCRIPTION)
    )
    others = sorted({*cache.nodes(hidden=False)} - simulators - followers)
    if simulators and others:
        more = f" and {len(others) - SHOWN} more" if len(others) > SHOWN else ""
        yield (
            f"{', '.join(others[:SHOWN])}{more} on the system's time, though {min(simulators)} publishes {CLOCK}; "
            "to follow that: -p use_sim_time:=true"
        )


def _answer(reply: bytes) -> dict[str, object]:
    """Parse a process's answer; empty if it cannot be read."""
    try:
        data = json.loads(reply) if len(reply) <= REPLY_BOUND else {}
    except (ValueError, RecursionError):
        return {}
    return data if isinstance(data, dict) else {}


def _unheard(cache: GraphCache) -> tuple[list[str], list[str]]:
    """Report topics without publishers, and services that are called but not offered.

    Returns:
        Texts on names that are probably misspelt, and on the others.
    """
    near: list[str] = []
    far: list[str] = []
    for here, there, verbs, provides in (
        (Kind.SUBSCRIPTION, Kind.PUBLISHER, ("subscribes to", "subscribe to"), "publishes"),
        (Kind.CLIENT, Kind.SERVICE, ("calls", "call"), "offers"),
    ):
        offered = {e.name for e in cache.endpoints(there) if not is_hidden(e.name)}
        for name in sorted({e.name for e in cache.endpoints(here)} - offered):
            # A private name of a node is for others, who may come later.
            users = [e for e in cache.endpoints(here, name) if not name.startswith(f"{e.node_name}/")]
            who = sorted({e.node_name for e in users if not is_hidden(e.node_name)})
            if not who or is_hidden(name) or name in EVERYBODYS:
                continue
            text = f"{' and '.join(who)} {verbs[len(who) > 1]} {name}, which no node {provides}"
            types = {e.type for e in users}
            alike = [other for other in sorted(offered) if is_misspelt(name, other)]
            of_type = [other for other in alike if types & {e.type for e in cache.endpoints(there, other)}]
            best = nearest(name, of_type or alike, cutoff=0.0) or ""
            if best:
                near.append(f"{text}; did you mean {best}?")
            else:
                far.append(f"{text}{_nearest(cache, name, here, there)}")
    for text, is_near in _without_servers(cache):
        (near if is_near else far).append(text)
    return near, far


def _without_servers(cache: GraphCache) -> Iterator[tuple[str, bool]]:
    """Yield a text for each action that has clients and no server, and whether its name is probably misspelt."""
    ends = (cache.endpoints(kind) for kind in (Kind.CLIENT, Kind.SERVICE))
    wanted, offered = ({e.name for e in each if e.name.endswith(ACTION_SEND_GOAL)} for each in ends)
    actions = sorted(name.removesuffix(ACTION_SEND_GOAL) for name in offered)
    for name in sorted(wanted - offered):
        who = sorted({e.node_name for e in cache.endpoints(Kind.CLIENT, name) if not is_hidden(e.node_name)})
        action = name.removesuffix(ACTION_SEND_GOAL)
        best = next((other for other in actions if is_misspelt(action, other)), "")
        if who and not is_hidden(action):
            verb = "send goals" if len(who) > 1 else "sends goals"
            hint = f"; did you mean {best}?" if best else ""
            yield f"{' and '.join(who)} {verb} to {action}, which no node offers{hint}", bool(best)


def _nearest(cache: GraphCache, name: str, here: Kind, there: Kind) -> str:
    """Suggest names instead of one that no node offers: the most similar, or else those of its type.

    Topics of the node itself are none, and those of a type of std_msgs may be about anything.
    """
    users = list(cache.endpoints(here, name))
    types, nodes = {e.type for e in users}, {e.node_name for e in users if here is Kind.SUBSCRIPTION}
    offered = [e for e in cache.endpoints(there) if e.type in types and e.node_name not in nodes]
    same = sorted({e.name for e in offered if not is_hidden(e.name)} - {*EVERYBODYS})
    like = nearest(name, same)
    is_vague = any(type_.startswith("std_msgs/") for type_ in types)
    of_its_type = [like] if like else [] if is_vague else same[:SHOWN]
    return f"; available with that type: {', '.join(of_its_type)}" if of_its_type else ""


def _rate(then: Counts, now: Counts, key: tuple[str, str], words: tuple[str, ...], seconds: float) -> float:
    """Return the increase of counters per second."""
    if key not in then or key not in now:
        return 0.0
    return sum(now[key].get(word, 0.0) - then[key].get(word, 0.0) for word in words) / seconds
