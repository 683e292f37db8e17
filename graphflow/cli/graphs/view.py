"""`graphflow view`: serve the running graph to Foxglove, Lichtblick and PlotJuggler."""

from __future__ import annotations

import asyncio
import ipaddress
import socket
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import click

from graphflow.cli import exits, output
from graphflow.errors import UsageFault

if TYPE_CHECKING:
    from graphflow.runtime.node import Node

NODE = "foxglove_bridge"
PORT = 8765
"""The port to which viewers connect by default."""


@click.command(short_help="Serve the running graph to Foxglove, Lichtblick and PlotJuggler.")
@click.option(
    "-p", "--port", type=click.IntRange(0, 65535), default=PORT, show_default=True, help="Port of the server."
)
@click.option("--host", default="127.0.0.1", show_default=True, help="Address of the server; 0.0.0.0 for all.")
@click.option("--read-only", is_flag=True, help="Do not let viewers publish, call or set anything.")
@click.option("--allow-commands", is_flag=True, help="Let viewers on other machines publish, call and set, too.")
@click.option("--allow-page", "pages", multiple=True, help="Origin of a web page that may connect: https://HOST.")
@click.option("--node-name", default=NODE, show_default=True, help="Name of the serving node.")
@click.option("--rerun", "in_rerun", is_flag=True, help="Open the viewer Rerun instead: space, images, plots, log.")
@click.option("--save", type=click.Path(path_type=Path), help="With --rerun: write FILE.rrd instead of opening it.")
@click.option("--bag", type=click.Path(path_type=Path), help="Show a bag instead of the running graph.")
def view(
    port: int,
    host: str,
    read_only: bool,
    allow_commands: bool,
    pages: tuple[str, ...],
    node_name: str,
    in_rerun: bool,
    save: Path | None,
    bag: Path | None,
) -> int:
    """Serve the running graph to Foxglove, Lichtblick and PlotJuggler. Ctrl-C ends it.

    Topics, services, parameters and connections are served over Foxglove's WebSocket protocol. --host 0.0.0.0 serves
    other machines, too; they can only watch, unless --allow-commands is given.
    """
    if in_rerun:
        return _show_in_rerun(save, bag)
    if save is not None:
        raise UsageFault("--save is for Rerun: graphflow view --rerun --save FILE.rrd")
    if find_spec("websockets") is None:
        from graphflow.introspect.installation import requirement

        raise UsageFault(f"viewers need the extra `view`: pip install {requirement('view')}")
    from graphflow.cli.messages.types import use_project
    from graphflow.cli.temporary_node import run_with_node

    use_project()
    if bag is not None:
        return _play(bag, host, port, frozenset(pages))
    is_read_only = read_only or not (allow_commands or _is_loopback(host))

    async def work(node: Node) -> int:
        from graphflow.viewer.bridge import Bridge

        name = f"graphflow on {socket.gethostname()}"
        bridge = Bridge(node, name, is_read_only=is_read_only, pages=frozenset(pages))
        try:
            found = await bridge.open(host, port)
            _tell_address(host, found, ", read-only" if is_read_only else "")
            await asyncio.get_running_loop().create_future()
        finally:
            await bridge.close()
        return exits.OK

    return run_with_node(work, node_name)


def _tell_address(host: str, port: int, more: str = "") -> None:
    output.data(f"Serving viewers on ws://{_url_host(host)}:{port}{more}")
    output.talk("In Foxglove or Lichtblick: Open connection, Foxglove WebSocket. Ctrl-C ends it")


def _play(path: Path, host: str, port: int, pages: frozenset[str]) -> int:
    """Serve a bag, which viewers play, pause and seek in."""
    from graphflow.bag.reader import Bag
    from graphflow.transport.event_loop import loop
    from graphflow.viewer.playback import Playback

    async def work() -> None:
        playback = Playback(Bag(path), path.name, pages)
        if playback.left_out:
            output.talk(f"left out, as their types are not in the bag: {', '.join(playback.left_out)}")
        try:
            _tell_address(host, await playback.open(host, port), f", {path}")
            await playback.ended()
        finally:
            await playback.close()

    try:
        loop.run(work())
    except KeyboardInterrupt:
        return exits.OK
    return exits.OK


def _url_host(host: str) -> str:
    """Format a host for an address that viewers can open."""
    try:
        address = ipaddress.ip_address(host)
    except ValueError:
        return host
    if address.is_unspecified:
        return socket.gethostname()
    return f"[{address}]" if address.version == 6 else host


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _show_in_rerun(save: Path | None, bag: Path | None) -> int:
    """Show the running graph, or a bag, in Rerun; or write a file that it opens."""
    if find_spec("rerun") is None:
        from graphflow.introspect.installation import requirement

        raise UsageFault(f"--rerun needs the extra `rerun`: pip install {requirement('rerun')}")
    from graphflow.bag.reader import Bag
    from graphflow.cli.messages.types import use_project
    from graphflow.cli.temporary_node import run_with_node
    from graphflow.viewer.rerun.following import Following, replay
    from graphflow.viewer.rerun.recording import Recording

    use_project()
    source = Bag(bag) if bag is not None else None
    recording = Recording(str(bag or "graph"))
    recording.open(save)
    output.talk(f"writing {save}" if save is not None else "opened Rerun")
    if source is not None:
        output.talk(f"{replay(source, recording):,} messages of {bag}")
        return exits.OK
    output.talk("Ctrl-C ends it")

    async def work(node: Node) -> int:
        following = Following(node, recording)
        try:
            await following.run()
        finally:
            recording.close()
            output.talk(f"{following.count:,} messages")
        return exits.OK

    return run_with_node(work)
