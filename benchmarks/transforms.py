"""Look-ups through six frames, beside the same chain of 4x4 matrices; and the load of a buffer that receives 1,000
transforms a second from another process.

Goals: a look-up takes at most 20 us; the buffer at most 3 % of a core more than a node that only receives the messages.
"""

from __future__ import annotations

import asyncio
import sys
import time
import timeit
from multiprocessing.connection import Connection
from typing import Any

import numpy as np

from benchmarks.peers import Peer, finish, loop_of, rendezvous, run_on, stay_on_loop
from benchmarks.rounds import compare, goal
from graphflow import Node, subscription, timer
from graphflow.msgs.tf2_msgs.msg import TFMessage
from graphflow.runtime.context import Context
from graphflow.runtime.node_core import core_of
from graphflow.tf import Transform, Transforms
from graphflow.tf.frames import Frames
from graphflow.tf.poses import Pose, from_rpy

CHAIN = ("map", "odom", "base_footprint", "base_link", "arm", "wrist", "camera")
S = 10**9
REPEAT = 2_000
RATE, SECONDS = 1000.0, 5.0


def frames() -> Frames:
    """Ten seconds of a chain that moves at 30 Hz."""
    out = Frames(10 * S)
    for index in range(300):
        for parent, child in zip(CHAIN, CHAIN[1:], strict=False):
            pose = Pose((0.01 * index, 0.2, 0.3), from_rpy(0.1, 0.2, 0.01 * index))
            out.put(child, parent, 100 * S + index * S // 30, pose, is_static=False)
    return out


class Sender(Node):
    """Sends one transform of each of ten frames, a hundred times a second."""

    tf = Transforms(listen=False)

    @timer(hz=RATE / 10)
    async def step(self) -> None:
        for index in range(10):
            self.tf.send(Transform.of("odom", f"robot{index}", (1.0, 2.0, 0.0)))


class Listener(Node):
    """Keeps them."""

    tf = Transforms()


class Hearer(Node):
    """Only receives the messages."""

    @subscription(TFMessage, "/tf", depth=100)
    def heard(self, message: TFMessage) -> None:
        """Do nothing."""


def send(pipe: Connection) -> None:
    async def main() -> None:
        context = await Context.open()
        await core_of(Sender()).start(context)
        await stay_on_loop(pipe)

    run_on("asyncio", main())


async def load(kind: type[Node]) -> float:
    """Percent of a core that this process needs while it receives."""
    context = await Context.open()
    node = kind()
    await core_of(node).start(context)
    await asyncio.sleep(1.0)
    before, start = time.process_time(), time.monotonic()
    await asyncio.sleep(SECONDS)
    used = (time.process_time() - before) / (time.monotonic() - start) * 100
    await core_of(node).stop()
    await context.close()
    return used


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    known = frames()
    between = known.histories["camera"].stamps[150] + 1000
    matrices = [np.eye(4) + 0.01 * index for index in range(6)]

    def us(function: Any) -> float:
        return timeit.timeit(function, number=REPEAT) / REPEAT * 1e6

    found = compare(
        {
            "numpy, 6 matrices": lambda: us(lambda: np.linalg.multi_dot(matrices)),
            "the latest": lambda: us(lambda: known.find("map", "camera", 0)),
            "between two": lambda: us(lambda: known.find("map", "camera", between)),
        },
        rounds=rounds,
        unit="us",
        baseline="numpy, 6 matrices",
    )
    goal("look-up through 6 frames, us", found["the latest"][0], 20)
    keep = [rendezvous(), Peer(send)]
    loads = compare(
        {
            "receive": lambda: loop_of("asyncio").run_until_complete(load(Hearer)),
            "receive and keep": lambda: loop_of("asyncio").run_until_complete(load(Listener)),
        },
        rounds=max(3, rounds // 3),
        unit="% core",
        baseline="receive",
    )
    del keep
    goal("1,000 transforms/s, % of a core beyond receiving", loads["receive and keep"][0] - loads["receive"][0], 3)
    finish()


if __name__ == "__main__":
    main()
