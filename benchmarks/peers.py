"""The other side of a measurement: processes that echo, listen or answer, over raw Zenoh or through graphflow."""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import sys
import time
from collections.abc import Callable, Coroutine
from importlib.util import find_spec
from multiprocessing.connection import Connection
from typing import Any

import zenoh

from graphflow.domain import rendezvous_endpoint
from graphflow.executor.ledger import Ledger
from graphflow.executor.runner import Runner, RunnerSpec
from graphflow.qos import Qos
from graphflow.system import LOOP_VARIABLE
from graphflow.transport.config import config, open_session
from graphflow.transport.event_loop.loop import new_event_loop
from graphflow.transport.inbox import Inbox
from graphflow.transport.malloc import keep_freed_memory
from graphflow.transport.rendezvous import establish, free_endpoint
from graphflow.transport.zenoh import ZenohSession

LIMIT = 20.0
"""Seconds anything here may take."""
BESIDE = bytes(33)
"""An attachment's worth of bytes."""

LOOPS = ["asyncio", "uvloop"]
if find_spec("uvloop") is None:
    sys.exit("the benchmarks between processes need uvloop: pip install -e '.[dev,fast]'")


def loop_of(kind: str) -> asyncio.AbstractEventLoop:
    """The event loop that nodes run on without and with the extra `fast`, and what `loop.run` does before."""
    keep_freed_memory()
    os.environ[LOOP_VARIABLE] = kind
    return new_event_loop()


class Peer:
    """A process with one role; it says `ready`, and what it is told goes to it as lines of a pipe.

    Args:
        role: A function of this project's benchmarks, called in the new process with the pipe and `args`.
    """

    def __init__(self, role: Callable[..., None], *args: Any) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, its = context.Pipe()
        self.process = context.Process(target=role, args=(its, *args), daemon=True)
        self.process.start()
        self.hear()

    def hear(self) -> Any:
        """What it says next."""
        assert self.pipe.poll(LIMIT), "the other process is silent"
        return self.pipe.recv()

    def ask(self, word: str) -> Any:
        """Tell it something and return what it says to that."""
        self.pipe.send(word)
        return self.hear()


def stay(pipe: Connection, answer: Callable[[str], Any] = str) -> None:
    """Say that the process is ready, answer what it is asked, and end it with the pipe."""
    pipe.send("ready")
    try:
        while True:
            pipe.send(answer(pipe.recv()))
    except EOFError:
        os._exit(0)


async def stay_on_loop(pipe: Connection, answer: Callable[[str], Any] = str) -> None:
    """The same on an event loop."""
    loop = asyncio.get_running_loop()

    def heard() -> None:
        try:
            pipe.send(answer(pipe.recv()))
        except EOFError:
            os._exit(0)

    pipe.send("ready")
    loop.add_reader(pipe.fileno(), heard)
    await asyncio.Event().wait()


def run_on(kind: str, main: Coroutine[Any, Any, None]) -> None:
    """Run a coroutine on a loop of the kind, for the length of a process."""
    loop = loop_of(kind)
    asyncio.set_event_loop(loop)
    loop.run_until_complete(main)


def raw_session() -> zenoh.Session:
    """A Zenoh session configured as graphflow's, with Zenoh's shared memory, and with memory treated likewise."""
    keep_freed_memory()
    settings = config("peer", connect=[rendezvous_endpoint()], listen="tcp/127.0.0.1:0")
    settings.insert_json5("transport/shared_memory/enabled", "true")
    return open_session(settings)


def wait_matched(declared: Any, limit: float = LIMIT) -> None:
    """Wait until a raw publisher or querier knows of the other side."""
    deadline = time.monotonic() + limit
    while not declared.matching_status.matching:
        assert time.monotonic() < deadline, "the other side does not appear"
        time.sleep(0.005)


async def open_transport(out: str, back: str, handler: Callable[[Any], Any]) -> tuple[ZenohSession, Any, Any]:
    """A session of graphflow's transport, its receiver on `back` for `handler`, its sender on `out`."""
    loop = asyncio.get_running_loop()
    session = ZenohSession(loop)
    inbox = Inbox(session.bell, 100, lambda: None)
    runner = Runner(Ledger(loop), RunnerSpec("handler", handler, lambda *_: None), inbox.items)
    inbox.ready = runner.wake
    receiver = session.open_receiver(back, Qos(), inbox)
    return session, receiver, session.open_sender(out, Qos())


def rendezvous() -> Any:
    """A rendezvous of the benchmark's own, in this process; keep what is returned."""
    os.environ["GRAPHFLOW_RENDEZVOUS"] = free_endpoint()
    os.environ["GRAPHFLOW_DOMAIN"] = str(50_000 + os.getpid() % 10_000)
    return establish()


def finish() -> None:
    """End the process without waiting for Zenoh's threads."""
    sys.stdout.flush()
    os._exit(0)
