"""The time limit of a stop, and what keeps a process from ending."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import sys
import threading
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import psutil
import pytest

from graphflow.runtime.stop_limit import Step, StopLimit, Times, hindrances, is_reading, next_step
from tests.cases import slow
from tests.conftest import Machine
from tests.until import until


@pytest.mark.parametrize(
    ("times", "interrupts", "step"),
    [
        (Times(0.5, 0.5, 0.5, None), 0, Step.WAIT),
        (Times(4.9, 4.9, 4.9, None), 0, Step.WAIT),  # it still has time
        (Times(5.0, 5.0, 5.0, None), 0, Step.INTERRUPT),
        (Times(5.0, 2.5, 3.0, None), 0, Step.INTERRUPT),
        (Times(30.0, 2.0, 4.0, None), 0, Step.WAIT),  # nodes end one after another, with hooks that block briefly
        (Times(6.0, 0.5, 6.0, None), 1, Step.WAIT),
        (Times(6.0, 1.0, 6.0, None), 1, Step.END_BLOCKED),
        (Times(2.0, 1.8, 2.0, None), 1, Step.WAIT),  # input() was interrupted, and the line caught it
        (Times(6.0, 3.0, 6.0, None), 2, Step.END_BLOCKED),
        (Times(10.0, 0.0, 10.0, None), 0, Step.END_UNENDING),
        (Times(4.0, 0.0, 1.0, 3.0), 0, Step.WAIT),
        (Times(5.0, 0.0, 2.0, 2.0), 0, Step.END_UNENDING),
        (Times(8.0, 0.0, 1.0, 1.0), 0, Step.WAIT),  # the last node took long, and tasks are being cancelled
    ],
)
def test_what_is_due(times: Times, interrupts: int, step: Step) -> None:
    """A loop that answers is left alone while its nodes end; a blocked one is interrupted, and then ended."""
    is_interrupted = interrupts == 1
    assert next_step(times, is_reminded=True, is_interrupted=is_interrupted, interrupts=interrupts) is step


def test_an_interrupted_loop_that_is_blocked_again() -> None:
    """By a hook of the stop, it is interrupted once more."""
    times = Times(5.0, 2.5, 5.0, None)
    assert next_step(times, is_reminded=True, is_interrupted=False, interrupts=1) is Step.INTERRUPT


def test_the_reminder() -> None:
    """It comes once, after a second."""
    times = Times(1.0, 0.0, 1.0, None)
    assert next_step(times, is_reminded=False, is_interrupted=False, interrupts=0) is Step.REMIND
    assert next_step(times, is_reminded=True, is_interrupted=False, interrupts=0) is Step.WAIT


def test_a_thread_that_reads_the_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is recognized by the expression that it is in; a line that merely has such a call is not enough."""
    read, write = os.pipe()
    gate = threading.Lock()
    gate.acquire()

    def ask() -> None:
        gate.acquire(), input()

    with os.fdopen(read) as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        thread = threading.Thread(target=ask)
        thread.start()
        assert thread.ident is not None
        assert not is_reading(thread.ident)
        gate.release()
        while not is_reading(thread.ident):
            os.sched_yield()
        os.write(write, b"1\n")
        thread.join()
    os.close(write)


HASTY = """
import asyncio, os, time, graphflow
from graphflow.runtime import stop_limit

stop_limit.LIMIT, stop_limit.SILENCE, stop_limit.REST, stop_limit.NO_PROGRESS = 0.8, 0.6, 0.3, 3.0
"""
"""Programs with a limit of less than a second."""

BLOCKED = """
class Blocked(graphflow.Node):
    @graphflow.task
    async def work(self):
        print("up", flush=True)
        while True:
            pass

    async def on_shutdown(self):
        print("clean", flush=True)

graphflow.run(Blocked)
"""

ASKING = """
class Asking(graphflow.Node):
    @graphflow.task
    async def ask(self):
        stdin = os.fdopen(os.pipe()[0])
        print("up", flush=True)
        stdin.readline()

    async def on_shutdown(self):
        print("clean", flush=True)

graphflow.run(Asking)
"""

SWALLOWING = """
class Swallowing(graphflow.Node):
    @graphflow.task
    async def work(self):
        print("up", flush=True)
        while True:
            try:
                await asyncio.sleep(0.1)
            except:
                pass

graphflow.run(Swallowing)
"""

SPINNING = """
class Spinning(graphflow.Node):
    @graphflow.task
    async def work(self):
        print("up", flush=True)
        while True:
            try:
                time.sleep(0.1)
            except:
                pass

graphflow.run(Spinning)
"""

BLOCKED_AGAIN = """
class Blocked(graphflow.Node):
    @graphflow.task
    async def work(self):
        print("up", flush=True)
        while True:
            pass

    async def on_shutdown(self):
        while True:
            pass

graphflow.run(Blocked)
"""

READING = """
import threading

def read_port():
    while True:
        time.sleep(0.01)

class Reading(graphflow.Node):
    @graphflow.task
    async def start(self):
        threading.Thread(target=read_port, name="port").start()
        print("up", flush=True)

graphflow.run(Reading)
"""

POOLED = """
from concurrent.futures import ThreadPoolExecutor

class Pooled(graphflow.Node):
    @graphflow.task
    async def start(self):
        self.pool = ThreadPoolExecutor(1)
        self.pool.submit(time.sleep, 100.0)
        print("up", flush=True)

graphflow.run(Pooled)
"""

SLOW = """
class Slow(graphflow.Node):
    async def on_start(self):
        print("up", flush=True)

    async def on_shutdown(self):
        await asyncio.sleep(0.5)
        time.sleep(0.5)
        print("clean", flush=True)

graphflow.run(Slow("one"), Slow("two"), Slow("three"))
time.sleep(2.0)
print("saved", flush=True)
"""


@slow
@pytest.mark.real
@pytest.mark.parametrize(
    ("program", "number", "status", "answers"),
    [
        (BLOCKED, signal.SIGINT, 1, [".py:11 in work blocks the event loop", "clean"]),
        (ASKING, signal.SIGINT, 0, ["clean"]),
        (ASKING, signal.SIGHUP, 0, ["clean"]),
        (SWALLOWING, signal.SIGTERM, 1, ["ended without cleanup", "still running: work in ", ".py:14: write"]),
        (SPINNING, signal.SIGINT, 1, ["ended without cleanup", "py:14 catches what would end it"]),
        (BLOCKED_AGAIN, signal.SIGINT, 1, [".py:11 in work blocks", ".py:15 in on_shutdown blocks"]),
        (
            READING,
            signal.SIGINT,
            1,
            ["ended without cleanup", ".py:11 in read_port, thread 'port'; give a thread daemon="],
        ),
        (
            POOLED,
            signal.SIGTERM,
            1,
            ["ended without cleanup", "code outside this program, thread 'ThreadPoolExecutor-"],
        ),
        (SLOW, signal.SIGINT, 0, ["clean", "saved"]),
    ],
)
def test_programs_that_are_asked_to_end(
    machine: Machine, tmp_path: Path, program: str, number: int, status: int, answers: list[str]
) -> None:
    """Each ends by itself, the cause is named, and one that takes its time is left alone."""
    file = tmp_path / "program.py"
    file.write_text(HASTY + program)
    started = machine.start_python(str(file))
    started.wait_for("up")
    started.process.send_signal(number)
    assert started.wait() == status
    for answer in answers:
        assert answer in started.text
    assert ("ended without cleanup" in started.text) == (answers[0] == "ended without cleanup")


PROCESSES = """
import os
from concurrent.futures import ProcessPoolExecutor

class Pooled(graphflow.Node):
    @graphflow.task
    async def start(self):
        self.pool = ProcessPoolExecutor(1)
        print("worker", self.pool.submit(os.getpid).result(), flush=True)
        self.pool.submit(time.sleep, 100.0)
        print("up", flush=True)

graphflow.run(Pooled)
"""


@slow
@pytest.mark.real
def test_the_workers_of_a_process_pool_end_too(machine: Machine, tmp_path: Path) -> None:
    """They do not outlive the program that was ended without them."""
    file = tmp_path / "program.py"
    file.write_text(HASTY + PROCESSES)
    started = machine.start_python(str(file))
    started.wait_for("up")
    worker = int(started.text.partition("worker ")[2].split()[0])
    started.process.send_signal(signal.SIGTERM)
    assert started.wait() == 1
    assert "end a pool in on_shutdown: pool.shutdown(wait=False, cancel_futures=True)" in started.text
    until(lambda: not psutil.pid_exists(worker) or psutil.Process(worker).status() == psutil.STATUS_ZOMBIE)


@slow
@pytest.mark.real
def test_a_second_signal_ends_a_process_that_waits_for_a_thread(machine: Machine, tmp_path: Path) -> None:
    """As the reminder says."""
    file = tmp_path / "program.py"
    file.write_text(HASTY.replace("LIMIT, stop", "REMIND_AFTER, stop", 1).replace("= 0.8", "= 0.1") + READING)
    started = machine.start_python(str(file))
    started.wait_for("up")
    started.process.send_signal(signal.SIGINT)
    started.wait_for("still stopping (waiting for ")
    started.process.send_signal(signal.SIGINT)
    assert started.wait() == 1
    assert "ended without cleanup: it was asked twice" in started.text


def test_a_thread_that_works_is_named() -> None:
    """With its line; daemon threads are left out, since the process does not wait for them."""
    gate, inside = threading.Event(), threading.Semaphore(0)

    def works() -> None:
        inside.release()
        gate.wait()

    threads = [threading.Thread(target=works, name=name, daemon=name == "demon") for name in ("smith", "demon")]
    for thread in threads:
        thread.start()
        assert inside.acquire(timeout=10.0)
    told = [text for text in hindrances() if "'smith'" in text or "'demon'" in text]
    gate.set()
    for thread in threads:
        thread.join()
    assert [text.partition(" in ")[2] for text in told] == ["works, thread 'smith'"]


def test_a_thread_of_zenoh_is_not_named() -> None:
    """It ends with the session; one of another library, which nothing ends, is."""
    gate = threading.Event()
    threads = [threading.Thread(target=gate.wait, name=f"Thread-7 ({name})") for name in ("pyo3-closure", "works")]
    for thread in threads:
        thread.start()
    told = [text for text in hindrances() if "Thread-7" in text]
    gate.set()
    for thread in threads:
        thread.join()
    assert told == ["code outside this program, thread 'Thread-7 (works)'"]


def wait_for(gate: Path) -> None:
    """Work for another process, until there is a file."""
    while not gate.exists():
        os.sched_yield()


@pytest.mark.real
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_process_pool_at_work_is_named(tmp_path: Path) -> None:
    """With its processes, which can then be ended."""
    gate = tmp_path / "gate"
    with ProcessPoolExecutor(1) as pool:
        work = pool.submit(wait_for, gate)
        told = [text for text in hindrances() if "process pool" in text]
        gate.touch()
        work.result(30.0)
    assert len(told) == 1
    assert told[0].startswith("the work of a process pool, processes ")


@pytest.mark.parametrize("former", [logging.NOTSET, logging.WARNING])
def test_what_a_blocked_loop_logs_is_left_out(former: int) -> None:
    """From the reminder until the nodes have stopped; what the program itself has disabled stays so."""
    loop = asyncio.new_event_loop()
    logger = logging.getLogger("blocked")
    logger.setLevel(logging.INFO)
    logging.disable(former)
    try:
        limit = StopLimit(loop, is_enforced=True)
        limit._remind()
        assert logger.isEnabledFor(logging.INFO) is (former < logging.INFO)  # it answers
        assert limit._ping()  # which nothing answers
        limit._remind()
        assert not logger.isEnabledFor(logging.INFO)
        assert logger.isEnabledFor(logging.ERROR)
        limit.closed()
        assert logging.root.manager.disable == former
    finally:
        logging.disable(logging.NOTSET)
        loop.close()
