"""The work of `bag play`: play a bag with keys, services and a progress line."""

from __future__ import annotations

import asyncio
import contextlib
import sys
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TypeVar

from graphflow.bag.info import topics_of
from graphflow.bag.player import MAX_RATE, MIN_RATE, Player, PlayOptions
from graphflow.bag.reader import Bag
from graphflow.cli import exits, output
from graphflow.cli.keys import DOWN, RIGHT, UP, key_presses
from graphflow.cli.temporary_node import run_with_node
from graphflow.msgs.rosbag2_interfaces.srv import (
    Burst,
    GetRate,
    IsPaused,
    Pause,
    PlayNext,
    Resume,
    Seek,
    SetRate,
    TogglePaused,
)
from graphflow.names import is_hidden
from graphflow.runtime.node import Node
from graphflow.wire.liveliness import Kind

R = TypeVar("R")

NAMED = 3
"""Topics without subscriptions that are named."""
STAY = 0.2
"""Seconds that the publishers stay after the last message, so that it is delivered."""
SHOWN_EVERY = 0.2


def run(path: Path, options: PlayOptions, name: str, *, keys: bool = True, burst: int | None = None) -> int:
    """Play until done or stopped; return the exit code.

    Args:
        burst: Number of messages to publish at once, 0 for all; None to play in time.
    """
    bag = Bag(path)
    if not bag.contents.is_whole:
        count = bag.contents.message_count
        output.talk(f"note: {path} was not closed properly; {count:,} messages can be read")

    async def work(node: Node) -> int:
        return await _play(node, bag, options, burst, keys=keys)

    return run_with_node(work, name, has_services=True)


def rivals(node: Node, topics: Iterable[str]) -> Iterator[str]:
    """Report other nodes that publish what is played: their messages and those of the bag would mix."""
    for topic in sorted(set(topics) - {"/rosout", "/parameter_events", "/tf", "/tf_static"}):
        others = {e.node_name for e in node.context.cache.endpoints(Kind.PUBLISHER, topic)} - {node.full_name}
        named = sorted(name for name in others if not is_hidden(name))
        if named:
            yield f"{named[0]} publishes {topic}, too, and both will mix: stop it, or play with -m {topic}:=/other"


async def _play(node: Node, bag: Bag, options: PlayOptions, burst: int | None, *, keys: bool) -> int:
    player = Player(node, bag, options)
    for line in player.refused:
        output.talk(f"not played: {line}")
    for line in player.absent:
        output.talk(f"note: {bag.path}: {line}")
    _serve(node, player)
    for line in rivals(node, [*player.topics, *(["/clock"] if options.clock_hz else [])]):
        output.talk(f"note: {line}")

    def handle(key: str) -> None:
        if key == " ":
            player.is_paused = not player.is_paused
        elif key in (RIGHT, "s", "S"):
            player.step()
        elif key in (UP, DOWN):
            player.rate = min(max(player.rate * (1.1 if key == UP else 1 / 1.1), MIN_RATE), MAX_RATE)

    began = time.monotonic()
    with key_presses(handle) if keys else contextlib.nullcontext(False) as has_keys:
        hint = " SPACE pauses, RIGHT steps, UP and DOWN change the rate, Ctrl-C ends it." if has_keys else ""
        output.talk(f"playing {topics_of(len(player.topics))} of {bag.path}.{hint}")
        shown = asyncio.ensure_future(_show(player, bag)) if sys.stderr.isatty() else None
        try:
            await (player.run() if burst is None else player.burst(burst))
            await node.clock.sleep(STAY)
        finally:
            if shown is not None:
                shown.cancel()
            output.progress("")
            output.talk(f"played {player.played:,} messages in {time.monotonic() - began:.1f} s")
            if unheard := player.unheard:
                more = f" and {len(unheard) - NAMED} more" if len(unheard) > NAMED else ""
                output.talk(f"note: no node has subscribed to {', '.join(unheard[:NAMED])}{more}")
    return exits.OK


async def _show(player: Player, bag: Bag) -> None:
    """Show the position in the bag as a progress line."""
    whole = bag.contents
    span = (whole.end_ns - whole.start_ns) / 1e9
    while True:
        here = (player.now_ns - whole.start_ns) / 1e9
        state = "paused" if player.is_paused else f"x{player.rate:.2f}"
        output.progress(f"{here:.1f} of {span:.1f} s  {state}  {player.played:,} messages")
        await asyncio.sleep(SHOWN_EVERY)


def _serve(node: Node, player: Player) -> None:
    """Provide the services of ROS 2's player."""

    def paused(value: bool | None, answer: R) -> R:
        player.is_paused = not player.is_paused if value is None else value
        return answer

    def set_rate(request: SetRate.Request) -> SetRate.Response:
        is_good = MIN_RATE <= request.rate <= MAX_RATE
        if is_good:
            player.rate = request.rate
        return SetRate.Response(success=is_good)

    def step(count: int) -> bool:
        player.step(count)
        return player.is_paused

    def seek(request: Seek.Request) -> Seek.Response:
        wanted = request.time.sec * 10**9 + request.time.nanosec
        is_there = wanted <= player.end_ns
        if is_there:
            player.seek(wanted)
        return Seek.Response(success=is_there)

    node.create_service(Pause, "~/pause", lambda _: paused(True, Pause.Response()))
    node.create_service(Resume, "~/resume", lambda _: paused(False, Resume.Response()))
    node.create_service(TogglePaused, "~/toggle_paused", lambda _: paused(None, TogglePaused.Response()))
    node.create_service(IsPaused, "~/is_paused", lambda _: IsPaused.Response(paused=player.is_paused))
    node.create_service(GetRate, "~/get_rate", lambda _: GetRate.Response(rate=player.rate))
    node.create_service(SetRate, "~/set_rate", set_rate)
    node.create_service(PlayNext, "~/play_next", lambda _: PlayNext.Response(success=step(1)))
    node.create_service(
        Burst, "~/burst", lambda r: Burst.Response(actually_burst=step(r.num_messages) * r.num_messages)
    )
    node.create_service(Seek, "~/seek", seek)
