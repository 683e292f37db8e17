"""The work of `topic hz`, `topic bw` and `topic delay`: measure arriving messages."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import replace
from itertools import islice

from graphflow.cli import output
from graphflow.cli.messages.conditions import compile_condition
from graphflow.cli.temporary_node import run_with_node
from graphflow.errors import DecodeError, UsageFault
from graphflow.introspect.empty_hint import nothing_here, why_silent
from graphflow.introspect.messages.rates import Arrivals, Delays, Weights, table
from graphflow.msgs import registry
from graphflow.qos import BEST_AVAILABLE, Durability
from graphflow.runtime.endpoints import raw
from graphflow.runtime.node import Node
from graphflow.times import to_ns
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.liveliness import Kind

EVERY = 1.0
"""Seconds between two lines of output."""
POLL = 0.05
"""Seconds between two checks for new topics and output."""
QOS = replace(BEST_AVAILABLE, durability=Durability.VOLATILE, depth=2000)
"""QoS of the subscriptions: no messages from before, and a depth that takes bursts."""
TYPES_BOUND = 4
"""The types of one topic that are measured, at most: a misleading announcement must not hide the others."""
SILENT = 2.0
"""Seconds without messages after which a warning is printed."""


Take = Callable[[bytes, int, int], object]
"""Function that takes a payload and its times of arrival: on the monotonic clock and on the node's, in nanoseconds."""


def hz(topics: list[str], window: int, expression: str, *, as_json: bool) -> int:
    """Print how often messages arrive; return the exit code."""
    condition = compile_condition(expression) if expression else None
    rates = {topic: Arrivals(window) for topic in topics}

    def meter(topic: str, type_name: str) -> Take:
        add = rates[topic].add
        if condition is None:
            return lambda _, now_ns, __: add(now_ns)
        decode = registry.codec(type_name).decode
        return lambda payload, now_ns, _: condition(decode(payload)) and add(now_ns)

    def report(_: int) -> None:
        if as_json:
            _print_numbers({topic: one.numbers() for topic, one in rates.items()})
        else:
            _print_text(table(rates) if len(topics) > 1 else rates[topics[0]].text())

    return run_with_node(lambda node: _measure(node, topics, meter, report))


def bw(topics: list[str], window: int, *, as_json: bool) -> int:
    """Print how many bytes arrive; return the exit code."""
    weights = {topic: Weights(window) for topic in topics}
    if not as_json:
        output.lines(f"Subscribed to [{topic}]" for topic in topics)

    def meter(topic: str, _: str) -> Take:
        add = weights[topic].add
        return lambda payload, now_ns, _: add(now_ns, len(payload))

    def report(now_ns: int) -> None:
        if as_json:
            _print_numbers({topic: one.numbers(now_ns) for topic, one in weights.items()})
            return
        texts = {topic: words for topic, one in weights.items() if (words := one.text(now_ns))}
        _print_text("\n".join(f"{topic}: {words}" if len(topics) > 1 else words for topic, words in texts.items()))

    return run_with_node(lambda node: _measure(node, topics, meter, report))


def delay(topic: str, window: int, *, as_json: bool) -> int:
    """Print how old messages are on arrival; return the exit code."""
    delays = Delays(window)

    def meter(_: str, type_name: str) -> Take:
        fields = {f.name: f.type.base for f in registry.message_schema(type_name).fields}
        if fields.get("header") != "std_msgs/msg/Header":
            raise UsageFault(f"{type_name} has no header, so no stamp from which a delay could be measured")
        decode = registry.codec(type_name).decode

        def take(payload: bytes, _: int, time_ns: int) -> None:
            stamp = decode(payload).header.stamp
            delays.add(time_ns - (stamp.sec * 10**9 + stamp.nanosec))

        return take

    def report(_: int) -> None:
        _print_numbers({topic: delays.numbers()}) if as_json else _print_text(delays.text())

    return run_with_node(lambda node: _measure(node, [topic], meter, report))


def _print_text(text: str) -> None:
    if text:  # empty after a single message, which has no rate
        output.data(text)


def _print_numbers(found: Mapping[str, Mapping[str, float] | None]) -> None:
    """Print a line of JSON for each topic with measurements."""
    for topic, numbers in found.items():
        if numbers is not None:
            output.as_json({"topic": topic, **numbers})


async def _measure(
    node: Node, topics: list[str], meter: Callable[[str, str], Take], report: Callable[[int], None]
) -> int:
    """Subscribe to topics as each gets a publisher, and report every second; ends by cancellation or a fault."""
    clock, cache = node.clock, node.context.cache
    failed: list[UsageFault] = []
    count = 0

    def listen(topic: str, type_name: str, type_hash: str) -> None:
        take = meter(topic, type_name)

        def arrived(payload: bytes, _: MessageInfo) -> None:
            nonlocal count
            count += 1
            try:
                take(payload, clock.monotonic_ns(), clock.time_ns())
            except (UsageFault, DecodeError) as error:
                failed.append(UsageFault(str(error)))

        raw.subscribe(node, type_name, topic, arrived, QOS, type_hash=type_hash)

    waiting, reported = set(topics), 0
    next_ns = (arrived_ns := clock.monotonic_ns()) + to_ns(EVERY)
    has_warned = False
    while not failed:
        for topic in sorted(waiting):
            if publishers := cache.endpoints(Kind.PUBLISHER, topic):
                waiting.discard(topic)
                _listen_to_all(topic, [(publisher.type, publisher.hash) for publisher in publishers], listen)
        await clock.sleep(POLL)
        now_ns = clock.monotonic_ns()
        if now_ns >= next_ns:
            next_ns += to_ns(EVERY)
            if count > reported:
                reported, arrived_ns, has_warned = count, now_ns, False
                report(now_ns)
        if now_ns - arrived_ns >= to_ns(SILENT) and not has_warned:
            has_warned = True
            await _warn_of_silence(node, topics, waiting)
    raise failed[0]


def _listen_to_all(topic: str, announced: Iterable[tuple[str, str]], listen: Callable[[str, str, str], object]) -> None:
    """Listen to a topic with each of its types and hashes, up to `TYPES_BOUND`.

    Raises:
        UsageFault: The only type cannot be measured; of several, the others are.
    """
    kinds = list(islice(dict.fromkeys(announced), TYPES_BOUND))
    if len(kinds) > 1:
        several = " and ".join(dict.fromkeys(type_name for type_name, _ in kinds))
        output.talk(f"WARNING: {topic} is published with several types, and all are measured: {several}")
    for type_name, type_hash in kinds:
        try:
            listen(topic, type_name, type_hash)
        except UsageFault as error:
            if len(kinds) == 1:
                raise
            output.talk(f"WARNING: {error}")


async def _warn_of_silence(node: Node, topics: list[str], unpublished: Collection[str]) -> None:
    """Explain why no messages arrive: topics without publishers, an empty domain, or a net profile."""
    cache = node.context.cache
    for topic in sorted(unpublished):
        output.talk(f"WARNING: {cache.unpublished(topic)}")
    if unpublished and not cache.nodes(hidden=False):
        output.talk(await node.offload(nothing_here, "no nodes"))
    if not unpublished:
        output.talk(await node.offload(why_silent, topics) or "no new messages")
