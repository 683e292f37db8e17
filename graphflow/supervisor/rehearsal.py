"""A node that lives for a moment in memory, in the preload process: its workers then share what a first time leaves.

That is what was compiled, looked up and cached on the way, and the interpreter's own notes in the code it ran.
"""

from __future__ import annotations

import asyncio
import logging

from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.context import Context
from graphflow.runtime.declare import Param, Publisher, subscription, timer
from graphflow.runtime.node import Node
from graphflow.transport.loop import new_event_loop
from graphflow.transport.memory import Network


def rehearse() -> None:
    """Make a node, run each kind of handler and stop it."""
    with asyncio.Runner(loop_factory=new_event_loop) as runner:
        runner.run(_rehearse())


async def _rehearse() -> None:
    done = asyncio.Event()

    class Rehearsal(Node):
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
    node = Rehearsal()
    node.log.setLevel(logging.DEBUG)
    await node.start(context)
    await done.wait()
    await node.stop()
    await context.close()
