"""Service calls, one after the other and 32 at a time: AddTwoInts through nodes beside a raw queryable.

Raw Zenoh answers in the callback and takes replies directly (`indirect=False`), which is its fastest form.

Goals: one caller at most 1.6 times raw on asyncio, 1.35 on uvloop; 32 in flight at least 0.7 of raw's rate.
"""

from __future__ import annotations

import asyncio
import sys
import threading
import time
from collections.abc import Callable
from functools import partial
from multiprocessing.connection import Connection
from typing import Any

import zenoh
from zenoh.handlers import Callback

from benchmarks.peers import (
    BESIDE,
    LIMIT,
    LOOPS,
    Peer,
    finish,
    loop_of,
    raw_session,
    rendezvous,
    run_on,
    stay,
    stay_on_loop,
)
from benchmarks.rounds import compare, goal
from graphflow import Node
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.runtime.context import Context
from graphflow.runtime.node_core import core_of

CALLS = 600
TOGETHER = 32
REQUEST = AddTwoInts.Request(a=2, b=3)

keep: list[Any] = []


def raw_server(pipe: Connection) -> None:
    payload = AddTwoInts.Response(sum=5).to_bytes()

    def asked(query: zenoh.Query) -> None:
        with query:
            query.reply("raw/add", payload, attachment=BESIDE)

    session = raw_session()
    keep.append(session.declare_queryable("raw/add", Callback(asked, indirect=False), complete=True))
    stay(pipe)


def node_server(pipe: Connection, loop: str) -> None:
    async def main() -> None:
        async def add(request: AddTwoInts.Request) -> AddTwoInts.Response:
            return AddTwoInts.Response(sum=request.a + request.b)

        node = Node(f"server_{loop}", enable_rosout=False)
        node.create_service(AddTwoInts, f"/{loop}/add", add)
        await core_of(node).start(await Context.open())
        await stay_on_loop(pipe)

    run_on(loop, main())


def raw_caller() -> Callable[[int], float]:
    """Microseconds a call with so many in flight: whoever is answered asks again."""
    session = raw_session()
    querier = session.declare_querier("raw/add", target=zenoh.QueryTarget.ALL_COMPLETE)
    keep.append((session, querier))
    payload = REQUEST.to_bytes()
    deadline = time.monotonic() + LIMIT
    while not querier.matching_status.matching:  # type: ignore[attr-defined]
        assert time.monotonic() < deadline
        time.sleep(0.005)

    def measure(together: int) -> float:
        done, lock, left = threading.Event(), threading.Lock(), [CALLS]

        def ask() -> None:
            querier.get(Callback(answered, indirect=False), payload=payload, attachment=BESIDE)

        def answered(_: Any) -> None:
            with lock:
                left[0] -= 1
                rest = left[0]
            if rest == 0:
                done.set()
            elif rest >= together:
                ask()

        began = time.perf_counter()
        for _ in range(together):
            ask()
        assert done.wait(LIMIT)
        return (time.perf_counter() - began) / CALLS * 1e6

    return measure


def node_caller(kind: str) -> Callable[[int], float]:
    loop = loop_of(kind)
    node = Node(f"caller_{kind}", enable_rosout=False)
    client = node.create_client(AddTwoInts, f"/{kind}/add")

    async def begin() -> None:
        await core_of(node).start(await Context.open())
        await client.wait_ready(LIMIT)

    async def one(calls: int) -> None:
        for _ in range(calls):
            await client.call(REQUEST)

    async def all_(together: int) -> float:
        began = time.perf_counter()
        async with asyncio.TaskGroup() as group:
            for i in range(together):
                group.create_task(one(CALLS // together + (i < CALLS % together)))
        return (time.perf_counter() - began) / CALLS * 1e6

    loop.run_until_complete(begin())
    return lambda together: loop.run_until_complete(all_(together))


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 11
    keep.append(rendezvous())
    keep.append(Peer(raw_server))
    callers = {"raw zenoh": raw_caller()}
    for loop in LOOPS:
        keep.append(Peer(node_server, loop))
        callers[f"nodes, {loop}"] = node_caller(loop)
    for together in (1, TOGETHER):
        print(f"\n{together} in flight: microseconds a call")
        contenders = {name: partial(caller, together) for name, caller in callers.items()}
        found = compare(contenders, rounds, "us", "raw zenoh")
        if together == 1:
            goal("one caller, asyncio / raw", found["nodes, asyncio"][1], 1.6)
            goal("one caller, uvloop / raw", found["nodes, uvloop"][1], 1.35)
        else:
            for loop in LOOPS:
                goal(f"{together} in flight, rate / raw's, {loop}", 1 / found[f"nodes, {loop}"][1], 0.7, at_least=True)
    finish()


if __name__ == "__main__":
    main()
