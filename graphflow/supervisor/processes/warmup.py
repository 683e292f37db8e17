"""The warm-up: a node runs once in the preload process, in memory, so that forked workers inherit warm caches.

Those are compiled code, lookups, and the inline caches of CPython's specializing interpreter.
"""

from __future__ import annotations

import asyncio
import logging
from contextlib import suppress

from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.context import Context
from graphflow.runtime.declarations.declare import Param, Publisher
from graphflow.runtime.declarations.handlers import subscription, timer
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.transport.event_loop.loop import new_event_loop
from graphflow.transport.memory import Network

LIMIT = 1.0
"""Seconds that a warm-up may take; it usually takes a hundredth of that."""


def warm_up() -> bool:
    """Create a node, let it receive its own message and stop it; returns whether the message arrived."""
    with asyncio.Runner(loop_factory=new_event_loop) as runner:
        return runner.run(_warm_up())


async def _warm_up() -> bool:
    done = asyncio.Event()

    class WarmUp(Node):
        rate = Param(1000.0, unit="Hz", gt=0.0, doc="Rate of the timer.")
        publisher = Publisher(String, "warm_up")

        @timer(hz=rate)
        async def publish(self) -> None:
            self.log.debug("publishing: '%s'", "something")
            self.publisher.publish(String(data="something"))

        @subscription(String, "warm_up")
        async def receive(self, message: String) -> None:
            done.set()

    context = Context(Network().session(asyncio.get_running_loop()))
    node = WarmUp()
    node.log.setLevel(logging.DEBUG)
    await core_of(node).start(context)
    with suppress(TimeoutError):  # without warm caches the workers only start more slowly
        async with asyncio.timeout(LIMIT):
            await done.wait()
    await core_of(node).stop()
    await context.close()
    return done.is_set()
