"""`graphflow tf tree`, `echo`, `monitor` and `static`."""

from __future__ import annotations

import asyncio
import math
import secrets
from collections.abc import Awaitable, Callable
from dataclasses import asdict
from typing import TypeVar

import click

from graphflow.cli import exits, output
from graphflow.cli.temporary_node import run_with_node
from graphflow.cli.verbs import GraphVerbs
from graphflow.errors import TransformError, UsageFault
from graphflow.introspect.empty_hint import nothing_here
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.tf import Transform, TransformBuffer
from graphflow.tf.text import described, monitored, remark, tree
from graphflow.times import NANOSECONDS, Time, to_ns
from graphflow.wire.liveliness import Kind

F = TypeVar("F", bound=Callable[..., object])

PATIENCE = 5.0
"""Seconds to wait for a transform that is shown once."""


@click.group(cls=GraphVerbs)
def tf() -> None:
    """Show transforms between frames; publish static ones."""


_time = click.option(
    "-t", "--time", "seconds", type=click.FloatRange(0, min_open=True), default=1.0, help="Seconds to listen."
)
_json = click.option("--json", "as_json", is_flag=True, help="Print JSON.")


def _listen(work: Callable[[TransformBuffer, Node], Awaitable[int]]) -> int:
    """Run `work` with the transforms that arrive meanwhile; returns its exit code."""

    async def run(node: Node) -> int:
        if node.context.cache.endpoints(Kind.PUBLISHER, "/clock"):  # ages and delays are those of the simulation
            node.parameters.set({"use_sim_time": True})
        return await work(TransformBuffer(node, core_of(node), to_ns(10.0), listen=True), node)

    return run_with_node(run)


@tf.command(name="tree")
@_time
@_json
def tree_(seconds: float, as_json: bool) -> None:
    """Draw the tree of frames, with rates, ages and publishers."""

    async def show(buffer: TransformBuffer, node: Node) -> int:
        await asyncio.sleep(seconds)
        infos, now = buffer.infos(), node.clock.now()
        if as_json:
            output.as_json([{**asdict(info), "newest": info.newest.seconds} for info in infos])
        elif infos:
            # Nanoseconds: one of the two times may be simulated.
            ages = {info.frame: (now.nanoseconds - info.newest.nanoseconds) / NANOSECONDS for info in infos}
            remarks = {info.frame: remark(info, ages[info.frame]) for info in infos}
            output.lines(tree({info.frame: info.parent for info in infos}, remarks))
        else:
            output.talk(nothing_here(f"no transforms in {seconds:g} s"))
        return exits.OK

    raise SystemExit(_listen(show))


@tf.command()
@click.argument("target", metavar="FRAME")
@click.argument("source", metavar="CHILD")
@click.argument("rate", type=click.FloatRange(0, min_open=True), default=1.0, required=False, metavar="[HZ]")
@click.option("-1", "--once", is_flag=True, help=f"Print one, and end; wait for it for at most {PATIENCE:g} s.")
@_json
def echo(target: str, source: str, rate: float, once: bool, as_json: bool) -> None:
    """Print the pose of the frame CHILD in FRAME, once a second or at a rate of HZ."""

    async def show(buffer: TransformBuffer, _: Node) -> int:
        waiting = ""
        while True:
            try:
                found = await buffer.lookup(target, source, timeout=PATIENCE if once else 1 / rate)
            except TransformError as error:
                if once:
                    output.talk(f"error: {error}")
                    return exits.TIMEOUT
                text = str(error).partition(" (waited")[0]
                if text != waiting:
                    output.talk(f"waiting for {text}")
                waiting = text
                continue
            waiting = ""
            _print(found, as_json=as_json)
            if once:
                return exits.OK
            await asyncio.sleep(1 / rate)

    raise SystemExit(_listen(show))


def _print(found: Transform, *, as_json: bool) -> None:
    if as_json:
        turns = dict(zip(("roll", "pitch", "yaw"), found.rpy, strict=True))
        place = {"translation": found.translation, "rotation": found.rotation, "rpy": turns}
        output.as_json({"frame": found.parent, "child": found.child, "time": found.stamp.seconds, **place})
    else:
        output.data(described(found))


@tf.command()
@click.argument("target", metavar="[FRAME]", required=False)
@click.argument("source", metavar="[CHILD]", required=False)
@click.option("-1", "--once", is_flag=True, help="Print one summary after a second, and end.")
def monitor(target: str | None, source: str | None, once: bool) -> None:
    """Print the delays of all frames, or of those between two, and the rates of their publishers each second."""
    if (target is None) != (source is None):
        raise UsageFault("tf monitor takes two frames, or none: graphflow tf monitor map base_link")

    async def show(buffer: TransformBuffer, node: Node) -> int:
        delays: list[float] = []
        while True:
            text = ""
            for _ in range(10):
                await asyncio.sleep(0.1)
                try:
                    chain = [] if target is None or source is None else buffer.chain(target, source)
                    stamp = buffer.get(chain[0], chain[-1]).stamp if chain else Time(0)
                except TransformError as error:
                    text = f"waiting for {error}"
                else:
                    # A chain of static frames has no time, and no delay.
                    delays += [(node.clock.now() - stamp).seconds] if stamp.nanoseconds else []
                    text = ""
            del delays[:-1000]
            if text:
                output.talk(text)
            else:
                output.data(f"{monitored(buffer.infos(), chain, delays)}\n")
            if once:
                return exits.TIMEOUT if text else exits.OK

    raise SystemExit(_listen(show))


def _number(name: str, help_: str, default: float | None = 0.0) -> Callable[[F], F]:
    return click.option(f"--{name}", type=float, default=default, help=help_, metavar="N")


@tf.command()
@click.argument("parent", metavar="FRAME", required=False)
@click.argument("child", metavar="CHILD", required=False)
@click.option("--frame-id", metavar="FRAME", help="The frame, as static_transform_publisher takes it.")
@click.option("--child-frame-id", metavar="CHILD", help="The frame that is placed in it.")
@_number("x", "Metres.")
@_number("y", "Metres.")
@_number("z", "Metres.")
@_number("roll", "Radians about x.")
@_number("pitch", "Radians about y.")
@_number("yaw", "Radians about z.")
@_number("qx", "A quaternion in place of the three angles.", None)
@_number("qy", "", None)
@_number("qz", "", None)
@_number("qw", "", None)
def static(
    parent: str | None,
    child: str | None,
    frame_id: str | None,
    child_frame_id: str | None,
    x: float,
    y: float,
    z: float,
    roll: float,
    pitch: float,
    yaw: float,
    **quaternion: float | None,
) -> None:
    """Publish where the frame CHILD is in FRAME, until Ctrl-C: `tf static map odom --x 1 --yaw 1.57`."""
    parent, child = parent or frame_id, child or child_frame_id
    if parent is None or child is None:
        raise UsageFault("tf static takes two frames: graphflow tf static map odom --x 1 --yaw 1.57")
    q = tuple(quaternion[name] for name in ("qx", "qy", "qz", "qw"))
    given = [value for value in q if value is not None]
    if given and (len(given) < 4 or roll or pitch or yaw):
        raise UsageFault("give all of --qx --qy --qz --qw, or the angles --roll --pitch --yaw")
    for name, angle in (("roll", roll), ("pitch", pitch), ("yaw", yaw)):
        if abs(angle) > math.tau:
            output.talk(f"note: --{name} is in radians: {angle:g} degrees are {math.radians(angle):.4g}")
    rotation = (given[0], given[1], given[2], given[3]) if given else None
    transform = Transform.of(parent, child, (x, y, z), rpy=(roll, pitch, yaw), rotation=rotation)

    async def hold(node: Node) -> int:
        buffer = TransformBuffer(node, core_of(node), to_ns(10.0), listen=False)
        buffer.send_static(transform)
        translation = ", ".join(f"{number:g}" for number in (x, y, z))
        output.talk(f"{child} is in {parent} at ({translation}) until Ctrl-C")
        await asyncio.Event().wait()
        return exits.OK

    raise SystemExit(run_with_node(hold, f"static_transform_publisher_{secrets.token_hex(4)}"))
