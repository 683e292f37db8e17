"""The ledger has an entry for every wait, for exactly as long as it lasts."""

from __future__ import annotations

import asyncio
import threading
from asyncio import Future
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

import pytest

from graphflow.executor.ledger import Ledger, PendingGoal
from graphflow.machines.waits.wait_graph import call_id

GID = bytes(range(16))


class Goal(PendingGoal):
    """A goal that was sent."""

    done = False


def future() -> Future[Any]:
    return asyncio.get_running_loop().create_future()


Case = tuple[AbstractContextManager[Any], Callable[[], object], object]
"""A wait, where it is written down, and as what."""


def call(ledger: Ledger) -> Case:
    key = future()
    entry = ledger.call(key, GID, 7, "/add", 1, 2)
    return entry, lambda: ledger.calls.get(key), entry


def goal(ledger: Ledger) -> Case:
    key, sent = future(), Goal()
    return ledger.goal(key, sent), lambda: ledger.goals.get(key), sent


def serving(ledger: Ledger) -> Case:
    key = future()
    return ledger.serving(key, GID), lambda: ledger.served.get(key), GID


def thread_work(ledger: Ledger) -> Case:
    key, thread = future(), threading.current_thread()
    return ledger.thread_work(key, thread), lambda: ledger.threads.get(key), thread


def asked_from(ledger: Ledger) -> Case:
    task = asyncio.current_task()
    assert task is not None
    return ledger.asked_from(5, task), lambda: ledger.asking.get(5), task


def opening(ledger: Ledger) -> Case:
    key = future()
    return ledger.opening(key, "/add", 5), lambda: ledger.openings.get(key), ("/add", 5)


def blocked_by(ledger: Ledger) -> Case:
    key = future()
    return ledger.blocked_by(key), lambda: ledger.blocking, key


@pytest.mark.parametrize("fails", [False, True])
@pytest.mark.parametrize("kind", [call, goal, serving, thread_work, asked_from, opening, blocked_by])
async def test_an_entry_while_it_is_entered(
    graphflow_runner: asyncio.Runner, kind: Callable[[Ledger], Case], fails: bool
) -> None:
    """It is there inside of the block, and gone afterwards, whether or not that failed."""
    wait, entry, expected = kind(Ledger(asyncio.get_running_loop()))

    assert entry() is None
    try:
        with wait:
            assert entry() == expected
            if fails:
                raise ValueError
    except ValueError:
        assert fails
    assert entry() is None


async def test_what_is_known_of_a_call(graphflow_runner: asyncio.Runner) -> None:
    """Its name everywhere, its service, and its times; no deadline is one too."""
    ledger = Ledger(asyncio.get_running_loop())

    with ledger.call(future(), GID, 7, "/add", 1, None) as entry:
        assert (entry.gid, entry.sequence, entry.service, entry.began_ns, entry.deadline_ns) == (
            GID,
            7,
            "/add",
            1,
            None,
        )


async def test_calls_alert(graphflow_runner: asyncio.Runner) -> None:
    """The deadlock search is alerted of each call that starts to wait, after its entry exists."""
    ledger = Ledger(asyncio.get_running_loop())
    seen: list[int] = []
    ledger.alert = lambda: seen.append(len(ledger.calls))

    with call(ledger)[0], goal(ledger)[0], call(ledger)[0], blocked_by(ledger)[0]:
        assert seen == [1, 2]
    assert seen == [1, 2]


async def test_a_call_that_was_taken_out(graphflow_runner: asyncio.Runner) -> None:
    """Its block ends as any other."""
    ledger = Ledger(asyncio.get_running_loop())

    with call(ledger)[0]:
        ledger.calls.clear()
    assert ledger.calls == {}


async def test_the_thread_of_the_loop(graphflow_runner: asyncio.Runner) -> None:
    """The ledger knows the loop and on which thread that runs."""
    ledger = Ledger(asyncio.get_running_loop())

    assert (ledger.loop, ledger.thread) == (asyncio.get_running_loop(), threading.get_ident())
    assert ledger.at_work is ledger.blocking is None


async def test_the_id_of_a_call(graphflow_runner: asyncio.Runner) -> None:
    """It is the same in the client's and the server's process."""
    assert Ledger(asyncio.get_running_loop()).call(future(), GID, 7, "/add", 0, None).id == call_id(GID, 7)
