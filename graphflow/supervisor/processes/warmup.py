"""A node that lives for a moment in memory, in the preload process: the workers then share what a first run leaves.

That is what was compiled, looked up and cached on the way, and what the interpreter noted in the code it ran.
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
"""Seconds that a warm-up may take; it takes a hundredth of that."""


def warm_up() -> bool:
    """Make a node, let it talk to itself and stop it; returns whether it heard itself."""
    with asyncio.Runner(loop_factory=new_event_loop) as runner:
        return runner.run(_warm_up())


async def _warm_up() -> bool:
    done = asyncio.Event()

    class WarmUp(Node):
        rate = Param(1000.0, unit="Hz", gt=0.0, doc="How often.")
        said = Publisher(String, "said")

        @timer(hz=rate)
        async def say(self) -> None:
            self.log.debug("It says: '%s'", "something")
            self.said.publish(String(data="something"))

        @subscription(String, "said")
        async def hear(self, message: String) -> None:
            done.set()

    context = Context(Network().session(asyncio.get_running_loop()))
    node = WarmUp()
    node.log.setLevel(logging.DEBUG)
    await core_of(node).start(context)
    with suppress(TimeoutError):  # then the workers do everything for the first time, and the graph runs anyway
        async with asyncio.timeout(LIMIT):
            await done.wait()
    await core_of(node).stop()
    await context.close()
    return done.is_set()
