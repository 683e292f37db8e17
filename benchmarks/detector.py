"""What the search for deadlocks costs, and how soon it finds one.

The cost: calls that a handler makes, with the search on and switched off, in interleaved rounds, beside a raw queryable
as `benchmarks.calls` has it. The time: two processes whose handlers call each other, from the later of the two calls to
the report; and a handler that calls itself, from the call to the error.

Goals: on at most 1.05 times off; 0.5 s to the report; 10 ms to the error.
"""

from __future__ import annotations

import asyncio
import logging
import statistics
import sys
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

from benchmarks.calls import CALLS, REQUEST, node_server, raw_caller, raw_server
from benchmarks.peers import LIMIT, Peer, finish, loop_of, rendezvous, run_on, stay_on_loop
from benchmarks.rounds import compare, goal
from graphflow import DeadlockError, Group, Node
from graphflow.interface import DeadlockPolicy
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.runtime.context import Context
from graphflow.runtime.node_core import core_of

keep: list[Any] = []


def handler_caller(policy: DeadlockPolicy, loop: asyncio.AbstractEventLoop) -> Callable[[], float]:
    """Microseconds a call, one after the other, made by a handler in a group."""
    node = Node(f"caller_{policy}", enable_rosout=False)
    client = node.create_client(AddTwoInts, "/asyncio/add")
    begun: asyncio.Queue[asyncio.Future[float]] = asyncio.Queue()

    async def work() -> None:
        done = await begun.get()
        began = time.perf_counter()
        for _ in range(CALLS):
            await client.call(REQUEST)
        done.set_result((time.perf_counter() - began) / CALLS * 1e6)

    async def begin() -> None:
        await core_of(node).start(await Context.open(deadlock=policy))
        await client.wait_ready(LIMIT)
        node.create_timer(0.001, work, group=Group(1))

    async def measure() -> float:
        done = loop.create_future()
        begun.put_nowait(done)
        value: float = await done
        return value

    loop.run_until_complete(begin())
    return lambda: loop.run_until_complete(measure())


class Heard(logging.Handler):
    """When a report was logged."""

    at = 0.0

    def emit(self, record: logging.LogRecord) -> None:
        if "DEADLOCK: " in record.getMessage():
            self.at = time.time()


def neighbour(pipe: Connection, name: str, other: str) -> None:
    """A node that calls the other one when it is told, in the group in which it would answer; tells when it called."""

    async def main() -> None:
        heard, called = Heard(), [0.0]
        logging.getLogger("graphflow").addHandler(heard)
        everything = Group(1)
        node = Node(name, enable_rosout=False)
        client = node.create_client(AddTwoInts, f"/{other}/f")
        wanted = asyncio.Event()

        async def f(request: AddTwoInts.Request) -> AddTwoInts.Response:
            return AddTwoInts.Response()

        async def cross() -> None:
            await wanted.wait()
            wanted.clear()
            await asyncio.sleep(0.1)
            called[0] = time.time()
            await client.call(REQUEST, timeout=3.0)

        node.create_service(AddTwoInts, f"/{name}/f", f, group=everything)
        await core_of(node).start(await Context.open(deadlock="report"))
        node.create_timer(0.01, cross, group=everything, on_error="log")

        def answer(word: str) -> Any:
            if word == "cross":
                heard.at = 0.0
                wanted.set()
                return "crossing"
            return called[0], heard.at

        await stay_on_loop(pipe, answer)

    run_on("asyncio", main())


def seconds_to_report(rounds: int) -> list[float]:
    peers = [Peer(neighbour, "left", "right"), Peer(neighbour, "right", "left")]
    keep.extend(peers)
    time.sleep(1.0)
    found = []
    for _ in range(rounds):
        for peer in peers:
            peer.ask("cross")
        time.sleep(2.0)
        times = [peer.ask("when") for peer in peers]
        reported = max(at for _, at in times)
        assert reported, "no report"
        found.append(reported - max(called for called, _ in times))
        time.sleep(2.5)
    return found


def milliseconds_to_error(loop: asyncio.AbstractEventLoop, rounds: int) -> list[float]:
    node = Node("narcissus", enable_rosout=False)
    everything, found = Group(1), []
    client = node.create_client(AddTwoInts, "/narcissus/f")

    async def f(request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response()

    async def call() -> None:
        began = time.perf_counter()
        try:
            await client.call(REQUEST)
        except DeadlockError:
            found.append((time.perf_counter() - began) * 1e3)

    async def run() -> None:
        logging.disable()
        node.create_service(AddTwoInts, "/narcissus/f", f, group=everything)
        await core_of(node).start(await Context.open())
        await client.wait_ready(LIMIT)
        node.create_timer(0.05, call, group=everything)
        while len(found) < rounds:
            await asyncio.sleep(0.05)
        await core_of(node).stop()
        logging.disable(logging.NOTSET)

    loop.run_until_complete(run())
    return found


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 11
    keep.append(rendezvous())
    keep.append(Peer(raw_server))
    raw = raw_caller()
    keep.append(Peer(node_server, "asyncio"))
    loop = loop_of("asyncio")
    contenders = {"raw zenoh": lambda: raw(1)}
    for policy in ("off", "raise"):
        contenders[f"search {policy}"] = handler_caller(policy, loop)
    found = compare(contenders, rounds, "us", "search off")
    goal("search on / off", found["search raise"][1], 1.05)
    errors = milliseconds_to_error(loop, rounds)
    print(f"a call that cannot succeed fails after {', '.join(f'{e:.2f}' for e in sorted(errors))} ms")
    goal("to the error, ms, median", statistics.median(errors), 10)
    reports = seconds_to_report(min(rounds, 7))
    print(f"a ring over two processes is reported after {', '.join(f'{r:.2f}' for r in sorted(reports))} s")
    goal("to the report, s, longest", max(reports), 0.5)
    finish()


if __name__ == "__main__":
    main()
