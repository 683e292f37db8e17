"""As many messages as go through in half a second, to one listener and to ten: raw Zenoh beside nodes.

Raw Zenoh publishes bytes of the same size with the same attachment, its congestion control once DROP, as graphflow's,
and once BLOCK, which holds the publisher. What counts is what was received; the share that was lost stands beside it.

Goals, received, as multiples of raw Zenoh with DROP: Twist 0.5, a 1 MB Image 0.7, one to ten 0.5.
"""

from __future__ import annotations

import asyncio
import sys
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

import zenoh

from benchmarks.peers import (
    BESIDE,
    Peer,
    finish,
    loop_of,
    raw_session,
    rendezvous,
    run_on,
    stay,
    stay_on_loop,
    wait_matched,
)
from benchmarks.rounds import compare, goal
from graphflow import Node, Qos
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.sensor_msgs.msg import Image
from graphflow.runtime.context import Context
from graphflow.runtime.node_core import core_of

SECONDS = 0.5
LOOP = "asyncio"
TWIST = Twist()
PICTURE = Image(height=1000, width=1000, encoding="mono8", step=1000, data=bytes(1_000_000))
BURST = 50
"""Messages between two looks at the clock; the loop of a node gets a turn there."""

keep: list[Any] = []


def raw_listener(pipe: Connection, key: str) -> None:
    """Counts what comes, copying each payload out."""
    counts = [0]

    def received(sample: Any) -> None:
        sample.payload.to_bytes()
        counts[0] += 1

    session = raw_session()
    keep.append((session, session.declare_subscriber(key, received)))
    stay(pipe, lambda _: counts[0])


def node_listener(pipe: Connection, topic: str, name: str, picture: bool) -> None:
    """Counts decoded messages in an async handler."""

    async def main() -> None:
        counts = [0]

        async def heard(message: Any) -> None:
            counts[0] += 1

        node = Node(name, enable_rosout=False)
        node.create_subscription(Image if picture else Twist, topic, heard, Qos(depth=1000))
        await core_of(node).start(await Context.open())
        await stay_on_loop(pipe, lambda _: counts[0])

    run_on(LOOP, main())


def received_per_second(listeners: list[Peer], send: Callable[[], int]) -> tuple[float, float]:
    """Messages a second that all listeners together have got while they were sent, and the share that never came."""
    before = sum(p.ask("count") for p in listeners)
    began = time.perf_counter()
    sent = send() * len(listeners)
    meanwhile = sum(p.ask("count") for p in listeners) - before
    took = time.perf_counter() - began
    got = -1
    while (now := sum(p.ask("count") for p in listeners) - before) != got:
        got = now
        time.sleep(0.1)
    return meanwhile / took, 1 - got / sent


class Lost(dict[str, list[float]]):
    """The share of losses by contender."""

    def measure(self, name: str, listeners: list[Peer], send: Callable[[], int]) -> Callable[[], float]:
        def once() -> float:
            rate, lost = received_per_second(listeners, send)
            self.setdefault(name, []).append(lost)
            return 1e6 / rate if rate else float("inf")

        return once


def raw_sender(key: str, payload: bytes, congestion: zenoh.CongestionControl) -> Callable[[], int]:
    session = raw_session()
    publisher = session.declare_publisher(key, congestion_control=congestion)
    keep.append(session)
    wait_matched(publisher)

    def send() -> int:
        sent, end = 0, time.perf_counter() + SECONDS
        while time.perf_counter() < end:
            for _ in range(BURST):
                publisher.put(payload, attachment=BESIDE)
            sent += BURST
        return sent

    return send


def node_sender(topic: str, message: Any, listeners: int) -> Callable[[], int]:
    loop = loop_of(LOOP)
    node = Node(f"sender{topic.replace('/', '_')}", enable_rosout=False)
    publisher = node.create_publisher(type(message), topic)

    async def begin() -> None:
        await core_of(node).start(await Context.open())
        await publisher.wait_matched(listeners)

    async def flood() -> int:
        sent, end = 0, time.perf_counter() + SECONDS
        while time.perf_counter() < end:
            for _ in range(BURST):
                publisher.publish(message)
            sent += BURST
            await asyncio.sleep(0)
        return sent

    loop.run_until_complete(begin())
    return lambda: loop.run_until_complete(flood())


def run(title: str, payload: bytes, message: Any, listeners: int, rounds: int, least: float) -> None:
    """Measure one size against one number of listeners."""
    print(f"\n{title}: microseconds for each message received")
    lost, picture = Lost(), isinstance(message, Image)
    contenders = {}
    for word, congestion in (("DROP", zenoh.CongestionControl.DROP), ("BLOCK", zenoh.CongestionControl.BLOCK)):
        key = f"raw/{word}/{len(payload)}/{listeners}"
        peers = [Peer(raw_listener, key) for _ in range(listeners)]
        contenders[f"raw zenoh, {word}"] = lost.measure(word, peers, raw_sender(key, payload, congestion))
        keep.extend(peers)
    topic = f"/stream{len(payload)}_{listeners}"
    peers = [Peer(node_listener, topic, f"l{len(payload)}_{listeners}_{i}", picture) for i in range(listeners)]
    keep.extend(peers)
    contenders["nodes, DROP"] = lost.measure("nodes", peers, node_sender(topic, message, listeners))
    found = compare(contenders, rounds, "us", "raw zenoh, DROP")
    shares = ", ".join(f"{name} {sorted(values)[len(values) // 2]:.0%}" for name, values in lost.items())
    print(f"lost (median): {shares}")
    goal(f"{title}, nodes' rate / raw's", 1 / found["nodes, DROP"][1], least, at_least=True)


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 7
    keep.append(rendezvous())
    run("Twist", TWIST.to_bytes(), TWIST, 1, rounds, 0.5)
    run("Image, 1 MB", PICTURE.to_bytes(), PICTURE, 1, rounds, 0.7)
    run("Twist, 1 to 10", TWIST.to_bytes(), TWIST, 10, rounds, 0.5)
    finish()


if __name__ == "__main__":
    main()
