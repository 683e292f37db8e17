"""What `topic pub` does once it has a message."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from graphflow.cli import exits, output
from graphflow.cli.messages.stamps import Path, stamp
from graphflow.cli.temporary_node import visit
from graphflow.msgs.base import Message
from graphflow.names import did_you_mean
from graphflow.qos import DEFAULT, Qos
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.mistakes.network.other_domains import alone_here
from graphflow.runtime.node import Node
from graphflow.times import to_ns
from graphflow.wire.liveliness import Kind

REACH_LIMIT = 2.0
"""Seconds that the way to an announced subscription may take."""

UNHEARD_AFTER = 1.5
"""Seconds after which it is said that nobody hears what is published."""


@dataclass
class PubOptions:
    """The options of `topic pub`, by the names click gives them."""

    rate: float = 1.0
    once: bool = False
    times: int | None = None
    print_every: int = 1
    wait_matching_subscriptions: int | None = None
    max_wait_time_secs: float | None = None
    keep_alive: float = 0.1
    node_name: str | None = None
    qos: Qos = DEFAULT
    is_series: bool = False
    """Whether each message is sent once, one after the other; otherwise there is one, which is sent again and again."""


class Draft(NamedTuple):
    """A message to be sent."""

    message: Message
    stamps: Sequence[Path] = ()
    """Fields that get the time at which it is sent."""


def run(topic: str, drafts: Sequence[Draft], options: PubOptions) -> int:
    """Publish until done or stopped; returns the exit code."""

    async def work(node: Node) -> int:
        return await _publish(node, topic, drafts, options)

    return visit(work, options.node_name)


async def _publish(node: Node, topic: str, drafts: Sequence[Draft], options: PubOptions) -> int:
    times = 1 if options.once else options.times
    publisher = node.create_publisher(type(drafts[0].message), topic, options.qos)
    needed = options.wait_matching_subscriptions
    if needed is None:
        needed = 1 if times else 0
    if not await _wait_for_subscriptions(node, topic, needed, options.max_wait_time_secs):
        near = await _near(node, topic)
        output.error(f"{topic}: fewer than {needed} subscriptions after {options.max_wait_time_secs:g} s{near}")
        return exits.TIMEOUT
    if needed:
        await _wait_until_reached(node, publisher)
    output.data("publisher: beginning loop")
    began_ns = node.clock.monotonic_ns()
    is_told = False
    async for n in node.clock.every(hz=options.rate):
        if not is_told and not publisher.is_wanted and node.clock.monotonic_ns() - began_ns > to_ns(UNHEARD_AFTER):
            is_told = True
            output.talk(f"no node hears {topic} so far{await _near(node, topic)}")
        message, stamps = drafts[n % len(drafts)]
        stamp(message, stamps, node.clock.time_ns())
        if options.print_every and n % options.print_every == 0:
            output.data(f"publishing #{n + 1}: {message!r}\n")
        publisher.publish(message)
        if n + 1 == times or (options.is_series and n + 1 == len(drafts)):
            break
    await node.clock.sleep(options.keep_alive)
    return exits.OK


async def _wait_for_subscriptions(node: Node, topic: str, needed: int, limit: float | None) -> bool:
    def enough() -> bool:
        return len(node.context.cache.endpoints(Kind.SUBSCRIPTION, topic)) >= needed

    if not needed or enough():
        return True
    output.data(f"Waiting for at least {needed} matching subscription(s)...")
    if limit is not None and limit <= UNHEARD_AFTER:
        return await _within(node, enough, limit)
    if await _within(node, enough, UNHEARD_AFTER):
        return True
    there = len(node.context.cache.endpoints(Kind.SUBSCRIPTION, topic))
    heard = f"{there} of {needed} nodes listen to" if there else "no node listens to"
    near = await _near(node, topic)
    output.talk(f"{heard} {topic} so far; Ctrl-C ends the waiting, and -w 0 publishes without it{near}")
    return await _within(node, enough, float(10**9) if limit is None else limit - UNHEARD_AFTER)


async def _near(node: Node, topic: str) -> str:
    """The topic that is probably meant, of those that somebody listens to; else the domain that is."""
    listened = {e.name for e in node.context.cache.endpoints(Kind.SUBSCRIPTION)} - {topic}
    return did_you_mean(topic, (), hidden=listened) or await alone_here(node.context, node.full_name)


async def _within(node: Node, holds: Callable[[], bool], limit: float) -> bool:
    """Wait until something holds of the graph; returns whether it did in time."""
    try:
        async with node.clock.timeout(limit):
            await node.context.wait_for(holds)
    except TimeoutError:
        return False
    return True


async def _wait_until_reached(node: Node, publisher: TopicPublisher[Any]) -> None:
    """Wait, not for long, until what is published reaches somebody: a subscription is announced before the way is."""
    until_ns = node.clock.monotonic_ns() + to_ns(REACH_LIMIT)
    while not publisher.is_wanted and node.clock.monotonic_ns() < until_ns:
        await node.clock.sleep(0.01)
