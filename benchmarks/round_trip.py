"""64 bytes there and back between two processes: raw Zenoh, graphflow's transport, and typed messages through nodes.

The transport's handlers are `async def` on both sides, stepped by the scheduler as a node's are.

Goal: the transport at most 1.45 times raw Zenoh.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import statistics
import sys
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

import zenoh

from benchmarks.rounds import compare, goal
from graphflow import Node
from graphflow.machines.group import GroupState
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.qos import Qos
from graphflow.runtime.context import Context
from graphflow.runtime.scheduler import Runner
from graphflow.transport.base import Inbox
from graphflow.transport.config import config, open_session, rendezvous_endpoint
from graphflow.transport.rendezvous import free_endpoint
from graphflow.transport.zenoh import ZenohSession

PAYLOAD = bytes(64)
BESIDE = bytes(33)
PINGS = 1500


class RawPeer:
    """One side over raw Zenoh's callbacks."""

    def __init__(self, out: str, back: str, received: Callable[[Any], None]) -> None:
        self.session = open_session(config("peer", connect=rendezvous_endpoint(), listen="tcp/127.0.0.1:0"))
        self.publisher = self.session.declare_publisher(out)
        self.subscriber = self.session.declare_subscriber(back, received)


def raw_ponger(ready: Connection) -> None:
    """Answer on `raw/pong` what comes on `raw/ping`."""
    peer: RawPeer

    def received(sample: Any) -> None:
        peer.publisher.put(sample.payload.to_bytes(), attachment=BESIDE)

    peer = RawPeer("raw/pong", "raw/ping", received)
    ready.send("ready")
    ready.recv()
    os._exit(0)


def transport_ponger(ready: Connection) -> None:
    """The same through the transport, with an async handler."""

    async def main() -> None:
        async def handler(arrival: Any) -> None:
            payload, _ = session.read(arrival)
            sender.put(payload, BESIDE)

        session, receiver, sender = await open_transport("tr/pong", "tr/ping", handler)
        ready.send("ready")
        await asyncio.to_thread(ready.recv)
        os._exit(receiver is None)

    asyncio.run(main())


async def open_transport(out: str, back: str, handler: Callable[[Any], Any]) -> tuple[ZenohSession, Any, Any]:
    """A session, its receiver on `back` and its sender on `out`."""
    loop = asyncio.get_running_loop()
    session = ZenohSession(loop)
    inbox = Inbox(session.bell, 100, lambda: None)
    runner = Runner(loop, "handler", GroupState(1), inbox.items, handler, lambda *_: None)
    inbox.ready = runner.wake
    return session, session.open_receiver(back, Qos(), inbox), session.open_sender(out, Qos())


def node_ponger(ready: Connection) -> None:
    """The same as typed messages through a node."""

    async def main() -> None:
        context = await Context.open()
        node = Node("ponger", enable_rosout=False)
        pong = node.create_publisher(Twist, "/pong")

        async def handler(message: Twist) -> None:
            pong.publish(message)

        node.create_subscription(Twist, "/ping", handler)
        await node.start(context)
        ready.send("ready")
        await asyncio.to_thread(ready.recv)
        os._exit(0)

    asyncio.run(main())


def start(target: Callable[[Connection], None]) -> Connection:
    """A ponger in a process of its own."""
    mine, its = multiprocessing.get_context("spawn").Pipe()
    multiprocessing.get_context("spawn").Process(target=target, args=(its,), daemon=True).start()
    assert mine.poll(20), "the ponger did not start"
    mine.recv()
    return mine


def raw_pinger() -> Callable[[], float]:
    """Measures a round over raw Zenoh: the callback sends the next ping."""
    import threading

    times: list[int] = []
    done = threading.Event()
    sent = 0

    def received(_: Any) -> None:
        nonlocal sent
        now = time.perf_counter_ns()
        times.append(now - sent)
        if len(times) == PINGS:
            done.set()
            return
        sent = time.perf_counter_ns()
        peer.publisher.put(PAYLOAD, attachment=BESIDE)

    peer = RawPeer("raw/ping", "raw/pong", received)
    matched(peer.publisher)

    def measure() -> float:
        nonlocal sent
        times.clear()
        done.clear()
        sent = time.perf_counter_ns()
        peer.publisher.put(PAYLOAD, attachment=BESIDE)
        assert done.wait(20), "a ping was lost"
        return statistics.median(times) / 1000

    return measure


def matched(publisher: zenoh.Publisher) -> None:
    """Wait until the other side is there."""
    deadline = time.monotonic() + 10
    while not getattr(publisher.matching_status, "matching", publisher.matching_status):
        assert time.monotonic() < deadline
        time.sleep(0.01)


class LoopPinger:
    """Measures rounds on a loop: an async handler sends the next ping."""

    def __init__(self) -> None:
        self.loop = asyncio.new_event_loop()
        self.times: list[int] = []
        self.sent = 0
        self.done: asyncio.Future[None] | None = None
        self.send: Callable[[], None]

    async def handler(self, _: Any) -> None:
        self.times.append(time.perf_counter_ns() - self.sent)
        if len(self.times) >= PINGS:
            assert self.done is not None
            self.done.set_result(None)
            return
        self.ping()

    def ping(self) -> None:
        self.sent = time.perf_counter_ns()
        self.send()

    def measure(self) -> float:
        async def rounds() -> None:
            self.times.clear()
            self.done = self.loop.create_future()
            self.ping()
            async with asyncio.timeout(20):
                await self.done

        self.loop.run_until_complete(rounds())
        return statistics.median(self.times) / 1000


def transport_pinger() -> Callable[[], float]:
    pinger = LoopPinger()

    async def handler(arrival: Any) -> None:
        session.read(arrival)
        await pinger.handler(arrival)

    session, _kept, sender = pinger.loop.run_until_complete(open_transport("tr/ping", "tr/pong", handler))
    pinger.send = lambda: sender.put(PAYLOAD, BESIDE)
    keep.append(_kept)
    time.sleep(0.5)
    return pinger.measure


def node_pinger() -> Callable[[], float]:
    pinger = LoopPinger()
    node = Node("pinger", enable_rosout=False)
    ping = node.create_publisher(Twist, "/ping")
    node.create_subscription(Twist, "/pong", pinger.handler)

    async def begin() -> None:
        context = await Context.open()
        await node.start(context)
        while not ping.get_subscription_count():
            await asyncio.sleep(0.01)

    pinger.loop.run_until_complete(begin())
    message = Twist()
    pinger.send = lambda: ping.publish(message)
    return pinger.measure


keep: list[Any] = []


def main() -> None:
    os.environ["GRAPHFLOW_RENDEZVOUS"] = free_endpoint()
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 15
    contenders = {}
    pingers = {"raw zenoh": (raw_ponger, raw_pinger), "transport": (transport_ponger, transport_pinger)}
    pingers["node, typed Twist"] = (node_ponger, node_pinger)
    from graphflow.transport.rendezvous import establish

    keep.append(establish())
    for name, (ponger, pinger) in pingers.items():
        keep.append(start(ponger))
        contenders[name] = pinger()
    found = compare(contenders, rounds, "us", "raw zenoh")
    goal("transport / raw zenoh", found["transport"][1], 1.45)
    for connection in keep:
        if isinstance(connection, Connection):
            connection.send("end")
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
