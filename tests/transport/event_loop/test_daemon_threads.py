"""Threads for work that blocks."""

from __future__ import annotations

import os
import subprocess
import sys
import threading

import pytest

from graphflow.transport.event_loop.daemon_threads import IDLE_LIMIT, DaemonExecutor, ThreadPool


def test_the_same_thread_is_used_again() -> None:
    """Also by who asks as soon as the work before has ended."""
    pool, ended = ThreadPool(), threading.Event()
    used = set[threading.Thread]()
    for _ in range(20):
        ended.clear()
        used.add(pool.run(lambda: None, lambda *_: ended.set(), "work"))
        assert ended.wait(10.0)
    assert len(used) == 1


def test_work_is_never_queued() -> None:
    """A thread for each, however many; those that are not needed later end."""
    pool, gate = ThreadPool(), threading.Event()
    number = IDLE_LIMIT + 4
    inside = threading.Semaphore(0)

    def work() -> None:
        inside.release()
        gate.wait()

    threads = [pool.run(work, lambda *_: None, "work") for _ in range(number)]
    for _ in range(number):
        assert inside.acquire(timeout=10.0)
    gate.set()
    ended: list[threading.Thread] = []
    while len(ended) < number - IDLE_LIMIT:
        ended = [thread for thread in threads if not thread.is_alive()]
    assert len(pool._idle) == IDLE_LIMIT


@pytest.mark.parametrize("error", [ValueError("no"), SystemExit(3)])
def test_errors_reach_who_waits(error: BaseException) -> None:
    """And the thread goes on."""
    pool, ended = ThreadPool(), threading.Event()
    seen: list[BaseException | None] = []

    def fail() -> None:
        raise error

    def done(_: None, raised: BaseException | None) -> None:
        seen.append(raised)
        ended.set()

    thread = pool.run(fail, done, "work")
    assert ended.wait(10.0)
    assert seen == [error]
    assert pool.run(lambda: None, lambda *_: None, "work") is thread


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
def test_a_forked_child_begins_with_none() -> None:
    """It would wait for a thread that only its parent has."""
    program = (
        "import os, threading\n"
        "from graphflow.transport.event_loop.daemon_threads import THREADS\n"
        "ended = threading.Event()\n"
        "THREADS.run(int, lambda *_: ended.set(), 'work'); ended.wait(10)\n"
        "child = os.fork()\n"
        "if child == 0:\n"
        "    ended = threading.Event()\n"
        "    THREADS.run(int, lambda *_: ended.set(), 'work')\n"
        "    os._exit(0 if ended.wait(10) else 1)\n"
        "print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))\n"
    )
    run = subprocess.run([sys.executable, "-W", "ignore", "-c", program], capture_output=True, text=True, timeout=60)
    assert (run.stdout, run.stderr) == ("0\n", "")


def test_there_are_threads_while_the_interpreter_ends() -> None:
    """Python 3.12 and later start none any more; some are kept for it."""
    program = (
        "import threading\n"
        "from graphflow.transport.event_loop.daemon_threads import RESERVE, THREADS\n"
        "THREADS.reserve()\n"
        "def late():\n"
        "    threading.main_thread().join()\n"
        "    gates = [threading.Event() for _ in range(RESERVE)]\n"
        "    for gate in gates:\n"
        "        THREADS.run(lambda: None, lambda *_, gate=gate: gate.set(), 'late')\n"
        "    print(all(gate.wait(10) for gate in gates))\n"
        "threading.Thread(target=late).start()\n"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert (run.stdout, run.stderr) == ("True\n", "")


def test_the_executor_of_a_loop_has_a_limit() -> None:
    """As asyncio's has; what waits is done as threads become free, and errors reach who waits."""
    executor, inside, most, lock = DaemonExecutor(), 0, 0, threading.Lock()
    gate = threading.Event()

    def work(number: int) -> int:
        nonlocal inside, most
        with lock:
            inside += 1
            most = max(most, inside)
        gate.wait()
        with lock:
            inside -= 1
        return 10 // number

    futures = [executor.submit(work, number) for number in range(3 * executor._max_workers)]
    gate.set()
    assert [future.result(10.0) for future in futures[1:]] == [10 // number for number in range(1, len(futures))]
    assert isinstance(futures[0].exception(10.0), ZeroDivisionError)
    assert most <= executor._max_workers


def test_what_is_cancelled_while_it_waits_is_not_done() -> None:
    """Nor is what waits at the end."""
    executor, gate, done = DaemonExecutor(), threading.Event(), list[int]()
    busy = [executor.submit(gate.wait) for _ in range(executor._max_workers)]
    cancelled, left = executor.submit(done.append, 1), executor.submit(done.append, 2)
    assert cancelled.cancel()
    executor.shutdown()
    gate.set()
    assert all(future.result(10.0) for future in busy)
    assert done == []
    assert left.cancelled()


def test_the_end_of_a_loop_waits_for_no_thread() -> None:
    """Neither does that of the interpreter."""
    program = (
        "import asyncio, threading\n"
        "from graphflow.transport.event_loop import loop\n"
        "async def main():\n"
        "    asyncio.get_running_loop().run_in_executor(None, threading.Event().wait)\n"
        "    await asyncio.to_thread(print, 'done')\n"
        "loop.run(main())\n"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=30)
    assert (run.stdout, run.stderr) == ("done\n", "")


def test_an_executor_without_threads_loses_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the system gives none, that is raised, and counts for nothing later."""
    executor = DaemonExecutor()
    with monkeypatch.context() as patch:
        patch.setattr(ThreadPool, "run", refuse)
        for _ in range(executor._max_workers):
            with pytest.raises(RuntimeError, match="no more threads"):
                executor.submit(int)
    assert executor.submit(int).result(10.0) == 0


def refuse(*_: object) -> None:
    raise RuntimeError("no more threads")
