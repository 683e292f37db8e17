"""64 bytes there and back between two processes: raw Zenoh, graphflow's transport, and typed messages through nodes.

The transport's handlers are `async def` on both sides, stepped by the scheduler as a node's are. Each contender has a
process of its own on the other side, with the same kind of event loop.

Goals, as multiples of raw Zenoh: the transport 1.35 on asyncio and 1.20 on uvloop, a typed Twist through nodes 1.60 and
1.40.
"""

from __future__ import annotations

import asyncio
import statistics
import sys
import threading
import time
from collections.abc import Callable
from functools import partial
from multiprocessing.connection import Connection
from typing import Any

from benchmarks.peers import (
    BESIDE,
    LIMIT,
    LOOPS,
    Peer,
    finish,
    loop_of,
    open_transport,
    raw_session,
    rendezvous,
    run_on,
    stay,
    stay_on_loop,
    wait_matched,
)
from benchmarks.rounds import compare, goal
from graphflow import Node
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.runtime.context import Context
from graphflow.runtime.node_core import core_of

PAYLOAD = bytes(64)
PINGS = 1000


def raw_ponger(pipe: Connection) -> None:
    """Answer on `raw/pong` what comes on `raw/ping`."""
    session = raw_session()
    publisher = session.declare_publisher("raw/pong")
    keep.append(
        session.declare_subscriber(
            "raw/ping", lambda sample: publisher.put(sample.payload.to_bytes(), attachment=BESIDE)
        )
    )
    stay(pipe)


def transport_ponger(pipe: Connection, loop: str) -> None:
    """The same through the transport, with an async handler."""

    async def main() -> None:
        async def handler(arrival: Any) -> None:
            payload, _ = session.read(arrival)
            sender.put(payload, attachment=BESIDE)

        session, _kept, sender = await open_transport(f"{loop}/pong", f"{loop}/ping", handler)
        await stay_on_loop(pipe)

    run_on(loop, main())


def node_ponger(pipe: Connection, loop: str) -> None:
    """The same as typed messages through a node."""

    async def main() -> None:
        context = await Context.open()
        node = Node(f"ponger_{loop}", enable_rosout=False)
        pong = node.create_publisher(Twist, f"/{loop}/pong")

        async def handler(message: Twist) -> None:
            pong.publish(message)

        node.create_subscription(Twist, f"/{loop}/ping", handler)
        await core_of(node).start(context)
        await stay_on_loop(pipe)

    run_on(loop, main())


def raw_pinger() -> Callable[[], float]:
    """Measures a round over raw Zenoh: the callback sends the next ping."""
    times: list[int] = []
    done = threading.Event()
    sent = 0

    def received(_: Any) -> None:
        nonlocal sent
        times.append(time.perf_counter_ns() - sent)
        if len(times) >= PINGS:
            done.set()
            return
        sent = time.perf_counter_ns()
        publisher.put(PAYLOAD, attachment=BESIDE)

    session = raw_session()
    publisher = session.declare_publisher("raw/ping")
    keep.append((session, session.declare_subscriber("raw/pong", received)))
    wait_matched(publisher)

    def measure() -> float:
        nonlocal sent
        times.clear()
        done.clear()
        sent = time.perf_counter_ns()
        publisher.put(PAYLOAD, attachment=BESIDE)
        assert done.wait(LIMIT), "a ping was lost"
        return statistics.median(times) / 1000

    return measure


class LoopPinger:
    """Measures rounds on a loop: an async handler sends the next ping."""

    def __init__(self, loop: str) -> None:
        self.loop = loop_of(loop)
        self.times: list[int] = []
        self.sent = 0
        self.done: asyncio.Future[None] | None = None
        self.send: Callable[[], None]

    async def handler(self, _: Any) -> None:
        self.times.append(time.perf_counter_ns() - self.sent)
        if len(self.times) < PINGS:
            self.ping()
        elif self.done is not None and not self.done.done():
            self.done.set_result(None)

    def ping(self) -> None:
        self.sent = time.perf_counter_ns()
        self.send()

    def measure(self) -> float:
        async def rounds() -> None:
            self.times.clear()
            self.done = self.loop.create_future()
            self.ping()
            async with asyncio.timeout(LIMIT):
                await self.done

        self.loop.run_until_complete(rounds())
        return statistics.median(self.times) / 1000


def transport_pinger(loop: str) -> Callable[[], float]:
    pinger = LoopPinger(loop)

    async def handler(arrival: Any) -> None:
        session.read(arrival)
        await pinger.handler(arrival)

    async def ready() -> None:
        while not sender.is_wanted:
            await asyncio.sleep(0.01)

    session, receiver, sender = pinger.loop.run_until_complete(open_transport(f"{loop}/ping", f"{loop}/pong", handler))
    keep.append(receiver)
    pinger.loop.run_until_complete(ready())
    pinger.send = partial(sender.put, PAYLOAD, attachment=BESIDE)
    return pinger.measure


def node_pinger(loop: str) -> Callable[[], float]:
    pinger = LoopPinger(loop)
    node = Node(f"pinger_{loop}", enable_rosout=False)
    ping = node.create_publisher(Twist, f"/{loop}/ping")
    pong = node.create_subscription(Twist, f"/{loop}/pong", pinger.handler)

    async def begin() -> None:
        await core_of(node).start(await Context.open())
        await ping.wait_matched()
        await pong.wait_matched()
        await asyncio.sleep(0.2)

    pinger.loop.run_until_complete(begin())
    message = Twist()
    pinger.send = partial(ping.publish, message)
    return pinger.measure


keep: list[Any] = []


def main() -> None:
    keep.append(rendezvous())
    keep.append(Peer(raw_ponger))
    contenders = {"raw zenoh": raw_pinger()}
    for loop in LOOPS:
        keep.append(Peer(transport_ponger, loop))
        contenders[f"transport, {loop}"] = transport_pinger(loop)
        keep.append(Peer(node_ponger, loop))
        contenders[f"node, Twist, {loop}"] = node_pinger(loop)
    found = compare(contenders, int(sys.argv[1]) if len(sys.argv) > 1 else 15, "us", "raw zenoh")
    goal("transport / raw zenoh, asyncio", found["transport, asyncio"][1], 1.35)
    goal("transport / raw zenoh, uvloop", found["transport, uvloop"][1], 1.20)
    goal("typed Twist / raw zenoh, asyncio", found["node, Twist, asyncio"][1], 1.60)
    goal("typed Twist / raw zenoh, uvloop", found["node, Twist, uvloop"][1], 1.40)
    finish()


if __name__ == "__main__":
    main()
