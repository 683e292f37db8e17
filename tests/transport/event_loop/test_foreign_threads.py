"""Callbacks on Zenoh's own threads."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable
from typing import Any

import pytest
import zenoh

from graphflow.transport.event_loop import foreign_threads
from graphflow.transport.event_loop.foreign_threads import at_once
from tests.cases import slow
from tests.conftest import LIMIT
from tests.until import until

pytestmark = pytest.mark.real


def beside(port: int) -> zenoh.Session:
    """A session of another participant: what it sends arrives on a thread of Zenoh's."""
    config = {"mode": "client", "connect": {"endpoints": [f"tcp/127.0.0.1:{port}"]}, "scouting": {"delay": 0}}
    return zenoh.open(zenoh.Config.from_json5(json.dumps(config)))


def send_one_by_one(router: zenoh.Session, port: int, put: Callable[[Any], None], heard: list[Any]) -> None:
    with beside(port) as other, router.declare_subscriber("a/b", at_once(put)):
        publisher = other.declare_publisher("a/b")
        until(lambda: bool(publisher.matching_status.matching))  # type: ignore[attr-defined]
        for count in range(1, 21):
            publisher.put(b"x")
            until(lambda count=count: len(heard) >= count)  # type: ignore[misc]


def test_a_thread_keeps_its_state(foreign_router: zenoh.Session, port: int) -> None:
    """So the values of a `threading.local` are there in the next callback: else each begins without any."""
    values, heard = threading.local(), list[tuple[int, int]]()

    def put(_: object) -> None:
        values.count = getattr(values, "count", 0) + 1
        heard.append((threading.get_ident(), values.count))

    send_one_by_one(foreign_router, port, put, heard)
    counted = {thread: [count for other, count in heard if other == thread] for thread, _ in heard}
    assert threading.get_ident() not in counted
    assert all(counts == list(range(1, len(counts) + 1)) for counts in counted.values())


@pytest.mark.parametrize("lack", ["room", "ctypes"])
def test_without_a_state_that_is_kept(
    foreign_router: zenoh.Session, port: int, lack: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Callbacks are called all the same: on more threads than are kept, and where there is no ctypes."""
    monkeypatch.setattr(foreign_threads, "_kept", set())
    if lack == "room":
        monkeypatch.setattr(foreign_threads, "THREADS_BOUND", 0)
    else:
        monkeypatch.setitem(sys.modules, "ctypes", None)
    heard: list[Any] = []
    send_one_by_one(foreign_router, port, heard.append, heard)
    assert bool(foreign_threads._kept) is (lack == "ctypes")


def test_the_end_of_what_is_asked(foreign_router: zenoh.Session) -> None:
    """`drop` is called when nothing more comes."""
    answers: list[Any] = []
    foreign_router.get("nobody/answers", at_once(answers.append, lambda: answers.append(None)), timeout=LIMIT)
    until(lambda: bool(answers))
    assert answers == [None]


ENDING = """\
import asyncio, os, sys
from graphflow.msgs.std_msgs.msg import String
from graphflow import Node, running, subscription

class Ear(Node):
    @subscription(String, "a")
    async def heard(self, m: String) -> None: ...

async def main():
    async with running(Ear()) as _:
        if sys.argv[1] == "exit":
            sys.exit(3)
        await asyncio.sleep(0.05)

if sys.argv[1] == "fork":
    pid = os.fork()
    asyncio.run(main())
    if pid:
        assert os.waitpid(pid, 0)[1] == 0
else:
    asyncio.run(main())
"""


@slow
@pytest.mark.parametrize(("way", "code"), [("end", 0), ("exit", 3), ("fork", 0)])
def test_processes_end(foreign_router: zenoh.Session, way: str, code: int) -> None:
    """By themselves, without a word, and so do their children."""
    env = {**os.environ, "PYTHONFAULTHANDLER": "1"}
    done = subprocess.run(
        [sys.executable, "-c", ENDING, way], env=env, capture_output=True, text=True, timeout=LIMIT, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (code, "", "")
