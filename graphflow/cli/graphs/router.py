"""`graphflow router`: the rendezvous as a program of its own, as `rmw_zenohd` is."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import click

from graphflow.cli import output
from graphflow.cli.net_options import apply_reach, reach_options
from graphflow.domain import rendezvous_endpoint

if TYPE_CHECKING:
    from graphflow.runtime.node import Node

POLL = 0.05
"""Seconds between two checks whether the rendezvous has been reached."""


@click.command()
@reach_options
def router(connect: tuple[str, ...], net: str | None) -> int:
    """Run a Zenoh router as the rendezvous of this machine. Ctrl-C ends it.

    None is needed: the first process of a graph is the rendezvous, and another takes over when it ends. A router
    outlives the graphs, and with --connect or --net keeps the machine linked to others.
    """
    from graphflow.cli.temporary_node import run_with_node

    apply_reach(connect, net)

    async def work(node: Node) -> int:
        endpoint = rendezvous_endpoint()
        if node.context.is_rendezvous:
            output.data(f"Started Zenoh router with id {node.context.router_id}")
            output.talk(f"ROS 2 and graphflow find each other at {endpoint}. Ctrl-C ends it")
        else:
            while not (zid := node.context.router_id):  # the connection is still being made
                await asyncio.sleep(POLL)
            output.data(f"There already is a Zenoh router at {endpoint}, with id {zid}")
            output.talk("This one takes over when that ends. Ctrl-C ends this one")
        await asyncio.get_running_loop().create_future()
        return 0

    return run_with_node(work)
