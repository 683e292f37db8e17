"""How late a 100 Hz timer is beside a subscription of the same node that blocks 20 ms for each of 62 messages a second.

That is more than the loop can do: the queue is always full. The baseline is what 64 runs in a row, however long, gave.

Goal: late by no more than two messages, in the median.
"""

from __future__ import annotations

import asyncio
import math
import statistics
import sys
import time
from functools import partial
from multiprocessing.connection import Connection

from benchmarks.peers import Peer, finish, loop_of, rendezvous, run_on, stay_on_loop
from benchmarks.rounds import compare, goal
from graphflow import Node, Publisher, subscription, timer
from graphflow.executor import runner
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.context import Context
from graphflow.runtime.node_core import core_of

BLOCKS = 0.02
MESSAGE_HZ, TIMER_HZ = 62.0, 100.0
SECONDS = 5.0


class Talker(Node):
    """Talks faster than anybody listens."""

    out = Publisher(String, "words")

    @timer(hz=MESSAGE_HZ)
    async def say(self) -> None:
        self.out.publish(String(data="word"))


class Busy(Node):
    """Blocks for each word, and would like to tick."""

    def __init__(self) -> None:
        super().__init__()
        self.ticks: list[float] = []

    @subscription(String, "words", depth=64)
    def heard(self, message: String) -> None:
        time.sleep(BLOCKS)

    @timer(hz=TIMER_HZ)
    async def tick(self) -> None:
        self.ticks.append(time.monotonic())


def talk(pipe: Connection) -> None:
    async def main() -> None:
        context = await Context.open()
        await core_of(Talker()).start(context)
        await stay_on_loop(pipe)

    run_on("asyncio", main())


async def gaps() -> list[float]:
    """Seconds between two ticks beyond a period, over some seconds under load."""
    node = Busy()
    context = await Context.open()
    await core_of(node).start(context)
    await asyncio.sleep(SECONDS)
    await core_of(node).stop()
    await context.close()
    ticks = node.ticks[len(node.ticks) // 5 :]  # the queue is full by then
    return [later - earlier - 1.0 / TIMER_HZ for earlier, later in zip(ticks, ticks[1:], strict=False)]


def late(slice_: float, worst: list[float]) -> float:
    """The median lateness in ms, weighted by how long each lasted: what a tick meets that is due at any time."""
    runner.SLICE = slice_
    found = sorted(loop_of("asyncio").run_until_complete(gaps()))
    worst.append(max(found) * 1e3)
    half, total = sum(max(gap, 0.0) for gap in found) / 2, 0.0
    for gap in found:
        total += max(gap, 0.0)
        if total >= half:
            return gap * 1e3
    return 0.0


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    keep = [rendezvous(), Peer(talk)]
    worst: dict[str, list[float]] = {"64 in a row": [], "a slice at a time": []}
    usual = runner.SLICE
    ways = {name: partial(late, s, worst[name]) for name, s in zip(worst, (math.inf, usual), strict=True)}
    found = compare(ways, rounds, "ms", "64 in a row")
    for name, values in worst.items():
        print(f"{name}: at worst {statistics.median(values):.0f} ms")
    goal("late, ms", found["a slice at a time"][0], 2 * BLOCKS * 1e3)
    del keep
    finish()


if __name__ == "__main__":
    main()
