"""`graphflow map show` and `save`."""

from __future__ import annotations

import asyncio
import shutil
from pathlib import Path

import click

from graphflow.cli import exits, output
from graphflow.cli.temporary_node import run_with_node
from graphflow.cli.verbs import GraphVerbs
from graphflow.errors import UsageFault
from graphflow.introspect.empty_hint import nothing_here
from graphflow.maps import picture
from graphflow.maps.files import FORMATS, FREE_THRESHOLD, OCCUPIED_THRESHOLD, read_map, write_map
from graphflow.maps.grid import GridMap
from graphflow.msgs.nav_msgs.msg import OccupancyGrid
from graphflow.qos import LATCHED
from graphflow.runtime.node import Node

PATIENCE = 5.0
"""Seconds to wait for a map."""


@click.group(cls=GraphVerbs)
def map() -> None:  # noqa: A001 - the verb's name
    """Show and save maps."""


_topic = click.option("-t", "--topic", default="/map", show_default=True, help="The topic of the map.")


def _received(topic: str) -> GridMap | None:
    """Return the latest map on a topic; None, with a message, if there is none, or a malformed one."""
    found: list[GridMap] = []

    async def listen(node: Node) -> int:
        came = asyncio.Event()

        def take(message: OccupancyGrid) -> None:
            try:
                found[:] = [GridMap.from_msg(message)]
            except ValueError as error:
                output.error(f"{topic}: {error}")
            came.set()

        node.create_subscription(OccupancyGrid, topic, take, LATCHED)
        try:
            async with asyncio.timeout(PATIENCE):
                await came.wait()
        except TimeoutError:
            output.talk(nothing_here(f"no map on {topic} in {PATIENCE:g} s"))
            return exits.TIMEOUT
        return exits.OK if found else exits.FAILED

    code = run_with_node(listen)
    if code:
        raise SystemExit(code)
    return found[0] if found else None


@map.command()
@click.argument("file", required=False, type=click.Path(path_type=Path))
@_topic
@click.option("-o", "--output", "out", type=click.Path(path_type=Path), help="Write a picture, such as map.png.")
def show(file: Path | None, topic: str, out: Path | None) -> None:
    """Draw the map of FILE, a map's YAML file, or of a topic."""
    if file is not None and file.suffix not in (".yaml", ".yml"):
        raise UsageFault(f"{file}: give the map's YAML file, such as {file.with_suffix('.yaml').name}")
    grid = read_map(file) if file is not None else _received(topic)
    if grid is None:
        return
    if out is not None:
        picture.write_picture(grid, out)
        output.talk(f"wrote {out}")
        return
    width, height = shutil.get_terminal_size()
    output.lines(picture.text(grid, width, max(5, height - 3)))
    output.talk(picture.described(grid))
    if remark := grid.remark:
        output.talk(f"note: {remark}")


@map.command()
@click.argument("name", type=click.Path(path_type=Path))
@_topic
@click.option(
    "--fmt", "fmt", type=click.Choice(FORMATS), default="pgm", show_default=True, help="The picture's format."
)
@click.option(
    "--mode", type=click.Choice(["trinary", "raw"]), default="trinary", show_default=True, help="See the docs."
)
@click.option(
    "--occ", type=click.FloatRange(0, 1), default=OCCUPIED_THRESHOLD, show_default=True, help="Occupied from."
)
@click.option("--free", type=click.FloatRange(0, 1), default=FREE_THRESHOLD, show_default=True, help="Free up to.")
def save(name: Path, topic: str, fmt: str, mode: str, occ: float, free: float) -> None:
    """Write the map of a topic as NAME.yaml and a picture, as ROS's map_saver does."""
    if free >= occ:
        raise UsageFault(f"--free {free:g} is not below --occ {occ:g}")
    grid = _received(topic)
    if grid is not None:
        described, drawn = write_map(grid, name, picture_format=fmt, mode=mode, occupied=occ, free=free)
        output.talk(f"wrote {described} and {drawn}: {picture.described(grid)}")
