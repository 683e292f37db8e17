"""The work of `doctor hello`: publish greetings, and count those of other machines."""

from __future__ import annotations

import asyncio
import socket
from collections import Counter

from graphflow.cli import exits, output
from graphflow.cli.temporary_node import run_with_node
from graphflow.msgs.std_msgs.msg import String
from graphflow.names import expand
from graphflow.runtime.node import Node

HELLO = "hello, it's me "
"""Text of ROS 2's `doctor hello` before the name of the machine."""
HOSTS_BOUND = 200
"""Most machines that are counted."""
NAME_BOUND = 255
"""Characters of a machine's name; the rest is cut."""


def greet(topic: str, emit_period: float, print_period: float, *, once: bool) -> int:
    """Publish and listen until Ctrl-C, or until the first table; return the exit code."""
    full = expand(topic, "/", "cli")

    async def work(node: Node) -> int:
        return await _greet(node, full, emit_period, print_period, once=once)

    return run_with_node(work)


async def _greet(node: Node, topic: str, emit_period: float, print_period: float, *, once: bool) -> int:
    publisher = node.create_publisher(String, topic, 10)
    heard: Counter[str] = Counter()

    node.create_subscription(String, topic, lambda message: _count(heard, message.data), 10, ignore_local=True)
    sent = 0

    async def publish() -> None:
        nonlocal sent
        while True:
            publisher.publish(String(data=f"{HELLO}{socket.gethostname()}"))
            sent += 1
            await asyncio.sleep(emit_period)

    publishing = asyncio.ensure_future(publish())
    try:
        while True:
            await asyncio.sleep(print_period)
            _print_table(topic, sent, heard, print_period)
            if once:
                return exits.OK
            heard.clear()
            sent = 0
    finally:
        publishing.cancel()


def _count(heard: Counter[str], greeting: str) -> None:
    """Count the greeting of a machine, unless too many others are counted."""
    host = greeting.removeprefix(HELLO)[:NAME_BOUND]
    if host in heard or len(heard) < HOSTS_BOUND:
        heard[host] += 1


def _print_table(topic: str, sent: int, heard: Counter[str], print_period: float) -> None:
    output.data("MULTIMACHINE COMMUNICATION SUMMARY")
    output.data(f"Topic: {topic}, Published Msg Count: {sent}")
    output.data("Subscribed from:" if heard else "Subscribed from: nobody")
    output.lines(f"  {host:<30} {count} messages in {print_period:g} s" for host, count in sorted(heard.items()))
    output.data("-" * 60)
