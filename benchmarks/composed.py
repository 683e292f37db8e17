"""A message between two nodes of one process, beside the same through raw Zenoh within one session.

Raw Zenoh gets the CDR bytes, and copies them out; the nodes get a message object each. Both are timed from the call to
the handler's end, in bursts that a queue holds. Goal: 20 us for a 1 MB Image, without a copy.
"""

from __future__ import annotations

import asyncio
import sys
import time
from typing import Any

import numpy as np
import zenoh

from benchmarks.peers import BESIDE, finish, loop_of, raw_session, rendezvous
from benchmarks.rounds import compare, goal
from graphflow import Node, Qos
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.sensor_msgs.msg import Image
from graphflow.runtime.context import Context
from graphflow.runtime.node_core import core_of

BURST = 100
PIXELS = 1_000_000

keep: list[Any] = []


def raw(payload: bytes) -> Any:
    """Microseconds for each message through raw Zenoh."""
    session, counts = raw_session(), [0]

    def received(sample: Any) -> None:
        sample.payload.to_bytes()
        counts[0] += 1

    key = f"composed/{len(payload)}"
    publisher = session.declare_publisher(key, congestion_control=zenoh.CongestionControl.DROP)
    keep.append((session, session.declare_subscriber(key, received), publisher))
    time.sleep(0.2)

    def once() -> float:
        counts[0], began = 0, time.perf_counter()
        for _ in range(BURST):
            publisher.put(payload, attachment=BESIDE)
        while counts[0] < BURST:
            time.sleep(0)
        return (time.perf_counter() - began) / BURST * 1e6

    return once


def nodes(topic: str, make: Any, kind: Any) -> Any:
    """Microseconds for each message from node to node."""
    loop, counts = loop_of("asyncio"), [0]
    sender, receiver = Node(f"sender_{topic}", enable_rosout=False), Node(f"receiver_{topic}", enable_rosout=False)
    publisher = sender.create_publisher(kind, topic)

    def heard(message: Any) -> None:
        counts[0] += 1

    receiver.create_subscription(kind, topic, heard, Qos(depth=BURST))

    async def begin() -> None:
        context = await Context.open()
        for node in (sender, receiver):
            await core_of(node).start(context)

    async def burst() -> float:
        counts[0], messages = 0, [make() for _ in range(BURST)]
        began = time.perf_counter()
        for message in messages:
            publisher.publish(message)
        while counts[0] < BURST:
            await asyncio.sleep(0)
        return (time.perf_counter() - began) / BURST * 1e6

    loop.run_until_complete(begin())
    return lambda: loop.run_until_complete(burst())


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 21
    keep.append(rendezvous())
    twist, picture, held = Twist(), Image(data=bytes(PIXELS)), np.zeros(PIXELS, np.uint8)
    found = compare(
        {
            "raw zenoh, 1 MB": raw(picture.to_bytes()),
            "Image, its own array": nodes("own", lambda: Image(data=np.zeros(PIXELS, np.uint8)), Image),
            "Image, bytes": nodes("bytes", lambda: picture, Image),
            "Image, an array that is held": nodes("held", lambda: Image(data=held), Image),
        },
        rounds,
        "us",
        "raw zenoh, 1 MB",
    )
    goal("Image between nodes, us", found["Image, its own array"][0], 20.0)
    found = compare(
        {"raw zenoh, Twist": raw(twist.to_bytes()), "Twist": nodes("twist", lambda: twist, Twist)},
        rounds,
        "us",
        "raw zenoh, Twist",
    )
    goal("Twist between nodes, as a multiple of raw Zenoh", found["Twist"][1], 1.0)
    finish()


if __name__ == "__main__":
    main()
