"""A script that ends by an exception while its session is open and its node subscribed."""

from __future__ import annotations

import asyncio

from graphflow import Context, Node
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.node_core import core_of


async def main() -> None:
    """Start a node, and leave."""
    context = await Context.open()
    node = Node("careless")
    node.create_subscription(String, "x", print)
    await core_of(node).start(context)
    raise SystemExit(3)


asyncio.run(main())
