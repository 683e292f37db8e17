"""The work of `topic pub`: publish messages once, repeatedly or as a series."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from graphflow.cli import exits, output
from graphflow.cli.messages.stamps import Path, stamp
from graphflow.cli.temporary_node import run_with_node
from graphflow.msgs.base import Message
from graphflow.names import did_you_mean, without_slash
from graphflow.qos import DEFAULT, Qos
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.mistakes.network.other_domains import alone_here
from graphflow.runtime.node import Node
from graphflow.times import to_ns
from graphflow.wire.liveliness import Kind

REACH_LIMIT = 2.0
"""Seconds that the route to an announced subscription may take to be set up."""

UNHEARD_AFTER = 1.5
"""Seconds without a subscription after which a warning is printed."""


@dataclass
class PubOptions:
    """The options of `topic pub`, under click's names."""

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
    """Whether each message is published once, in order; otherwise a single message is published repeatedly."""


class Draft(NamedTuple):
    """A message to be published."""

    message: Message
    stamps: Sequence[Path] = ()
    """Fields that are set to the time of publication."""


def run(topic: str, drafts: Sequence[Draft], options: PubOptions) -> int:
    """Publish until done or stopped; return the exit code."""

    async def work(node: Node) -> int:
        return await _publish(node, topic, drafts, options)

    return run_with_node(work, options.node_name)


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
    has_warned = False
    async for n in node.clock.every(hz=options.rate):
        if not has_warned and not publisher.is_wanted and node.clock.monotonic_ns() - began_ns > to_ns(UNHEARD_AFTER):
            has_warned = True
            output.talk(f"no node subscribes to {topic} so far{await _near(node, topic)}")
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
    count = len(node.context.cache.endpoints(Kind.SUBSCRIPTION, topic))
    state = f"{count} of {needed} nodes subscribe to" if count else "no node subscribes to"
    near = await _near(node, topic)
    output.talk(f"{state} {topic} so far; Ctrl-C ends the wait, and -w 0 publishes without it{near}")
    return await _within(node, enough, float(10**9) if limit is None else limit - UNHEARD_AFTER)


async def _near(node: Node, topic: str) -> str:
    """Suggest the topic with subscriptions, or else the domain, that was probably meant."""
    subscriptions = node.context.cache.endpoints(Kind.SUBSCRIPTION)
    for other in subscriptions:
        if topic == other.namespace + other.name:
            return f"; {other.node_name} subscribes to {other.name}: write {without_slash(other.name)}"
    others = {e.name for e in subscriptions} - {topic}
    return did_you_mean(topic, (), hidden=others) or await alone_here(node.context, node.full_name)


async def _within(node: Node, holds: Callable[[], bool], limit: float) -> bool:
    """Wait until a condition on the graph holds; return whether it did in time."""
    try:
        async with node.clock.timeout(limit):
            await node.context.wait_for(holds)
    except TimeoutError:
        return False
    return True


async def _wait_until_reached(node: Node, publisher: TopicPublisher[Any]) -> None:
    """Wait briefly for the route to a subscription: Zenoh announces the subscription before it sets up the route."""
    until_ns = node.clock.monotonic_ns() + to_ns(REACH_LIMIT)
    while not publisher.is_wanted and node.clock.monotonic_ns() < until_ns:
        await node.clock.sleep(0.01)
