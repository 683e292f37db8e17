"""The time limit of a stop: a thread that reports what keeps a process from ending, and ends it in the end.

The event loop cannot do this itself, since it may be blocked. A loop that answers pings is left alone as long as its
nodes end one after another, each within the limits of its steps. `next_step` decides; `StopLimit` acts.

A loop that is still in the line in which the signal found it is interrupted by `Interrupted`, as Ctrl-C interrupts any
program, so that the nodes can stop in order and call `on_shutdown`: at once where it reads the terminal, else after
`LIMIT`. Where that does not help, because the line catches it or is in C, the process ends without cleanup.

Source: docs/threads.md, "Signals"; the stop sequence of `machines.process`.
"""

from __future__ import annotations

import asyncio
import linecache
import logging
import os
import re
import signal
import sys
import threading
import time
from asyncio import AbstractEventLoop
from collections.abc import Iterator
from contextlib import suppress
from enum import Enum
from types import FrameType
from typing import NamedTuple, NoReturn

from graphflow.analysis.frames import stack_of
from graphflow.analysis.user_code import called_by_loop, innermost, is_users
from graphflow.runtime.mistakes import unawaited

LOOK_EVERY = 0.1
"""Seconds between two looks at the loop."""
INPUT_AFTER = 0.2
"""Seconds after a signal at which a loop that reads the terminal is interrupted."""
REMIND_AFTER = 1.0
"""Seconds after a signal at which a program that is still stopping reports what it waits for."""
LIMIT = 5.0
"""Seconds that a program has to end; a blocked loop is then interrupted. The supervisor's nodes have as many."""
SILENCE = 2.5
"""Seconds without an answer after which the loop counts as blocked: its hooks may block it for a while."""
LAST_SILENCE = 1.0
"""The same for a loop that was interrupted."""
REST = 2.0
"""Seconds, after all nodes have stopped, for the tasks that are left."""
NO_PROGRESS = 10.0
"""Seconds for the stop of one node, whose steps have limits of their own, unless they swallow their cancellation."""
INTERRUPTS = 2
"""Interruptions of the loop, at most; after the first, its nodes have `LIMIT` seconds to stop."""
TRIES = 200
"""Attempts to interrupt the loop, within `LAST_SILENCE`."""
_FRAGILE = (logging.__file__, unawaited.__file__)
"""Modules in which no error may be raised: one holds locks, the other is called by finalizers, which lose errors."""
_MANAGER = "_ExecutorManagerThread"
"""The class of the thread that keeps the interpreter alive until a `ProcessPoolExecutor` has finished."""
_POOL = "the work of a process pool"
_ZENOH = "(pyo3-closure)"
"""The end of the names of Zenoh's threads, which call a program's handlers and end with the session."""
_INPUT = re.compile(r"(?<![\w.])input\s*\(|\bstdin\b")
"""Pattern of an expression that reads the terminal."""


class Interrupted(KeyboardInterrupt):
    """Raised in the line that blocks the event loop of a program that was asked to end.

    Attributes:
        status: The exit status of the program.
    """

    def __init__(self, status: int) -> None:
        super().__init__()
        self.status = status


class Step(Enum):
    WAIT = "wait"
    REMIND = "remind"
    INTERRUPT = "interrupt"
    END_BLOCKED = "end a process whose loop is blocked"
    END_UNENDING = "end a process whose nodes or tasks go on"


class Times(NamedTuple):
    """Times of a stop, in seconds."""

    elapsed: float
    """Since the signal."""
    silent: float
    """Since the loop was pinged, if it has not answered."""
    unchanged: float
    """Since the signal, or the last node that has stopped."""
    closed: float | None
    """Since all nodes have stopped; None before."""


def next_step(times: Times, *, is_reminded: bool, is_interrupted: bool, interrupts: int) -> Step:
    """Decide what is due.

    Args:
        is_interrupted: Whether the loop was interrupted and has not answered since.
        interrupts: How often it was interrupted.
    """
    if times.elapsed >= LIMIT:
        if is_interrupted and times.silent >= LAST_SILENCE:
            return Step.END_BLOCKED
        if times.silent >= SILENCE and not is_interrupted:
            return Step.INTERRUPT if interrupts < INTERRUPTS else Step.END_BLOCKED
        if (times.closed or 0.0) >= REST or times.unchanged >= NO_PROGRESS:
            return Step.END_UNENDING
    return Step.REMIND if times.elapsed >= REMIND_AFTER and not is_reminded else Step.WAIT


class StopLimit:
    """The limit of one process. It must be made on the main thread, while the loop runs there.

    Args:
        is_enforced: Whether the process is ended; else it is only reported what it waits for.
    """

    def __init__(self, loop: AbstractEventLoop, *, is_enforced: bool) -> None:
        self._loop, self._is_enforced = loop, is_enforced
        self._main = threading.get_ident()
        self._number = 0
        self._interrupts: Interrupted | None = None
        """The error that the signal handler must raise."""
        self._unanswered = False
        self._changed = self._closed = self._cancelled = False
        self._former_level: int | None = None
        """The level up to which the program had disabled logging, while INFO is disabled here."""
        self.is_started = False

    def start(self, number: int) -> None:
        """Begin, in the handler of the first signal."""
        self._number, self.is_started = number, True
        threading.Thread(target=self._watch, name="graphflow-stop-limit", daemon=True).start()

    def changed(self) -> None:
        """Note that a node has stopped."""
        self._changed = True

    def closed(self) -> None:
        """Note that all nodes have stopped; a limit that is not enforced ends here."""
        self._closed = True
        if self._former_level is not None:
            logging.disable(self._former_level)
        self._cancelled = not self._is_enforced

    @property
    def interrupts(self) -> bool:
        """Whether the signals that arrive now are this thread's, to interrupt the main thread."""
        return self._interrupts is not None

    def interrupt(self, frame: FrameType | None) -> None:
        """Raise the error in the handler of such a signal, unless it would be lost there, or leave a lock held."""
        while frame is not None:
            if frame.f_code.co_filename in _FRAGILE:
                return
            frame = frame.f_back
        error, self._interrupts = self._interrupts, None
        if error is not None:
            raise error

    def _watch(self) -> None:
        # Looks are counted rather than seconds: a process that was stopped (SIGSTOP) has lost none of its time.
        total = elapsed = silent = unchanged = 0.0
        closed: float | None = None
        is_reminded = is_interrupted = False
        interrupts = 0
        pause = threading.Event()
        while not self._cancelled:
            has_answered = not self._unanswered  # before the next ping, which a hook may block at once
            if not self._ping():
                break
            pause.wait(LOOK_EVERY)
            total, elapsed = total + LOOK_EVERY, elapsed + LOOK_EVERY
            silent = silent + LOOK_EVERY if self._unanswered else 0.0
            unchanged = 0.0 if self._changed else unchanged + LOOK_EVERY
            self._changed = False
            if self._closed:
                closed = 0.0 if closed is None else closed + LOOK_EVERY
            if is_interrupted and (has_answered or not self._unanswered):
                is_interrupted = False
                elapsed = 0.0 if interrupts == 1 else elapsed
            if not interrupts and self._is_enforced and self._reads_terminal(elapsed, silent):
                is_interrupted, interrupts, silent = True, 1, 0.0
                self._interrupt(0)
                continue
            times = Times(elapsed, silent, unchanged, closed)
            due = next_step(times, is_reminded=is_reminded, is_interrupted=is_interrupted, interrupts=interrupts)
            if due is Step.REMIND:
                is_reminded = True
                self._remind()
            elif self._is_enforced and due is Step.INTERRUPT:
                say(f"{self._place()} blocks the event loop {total:.0f} s after the signal, and is interrupted")
                is_interrupted, interrupts, silent = True, interrupts + 1, 0.0
                self._interrupt(1)
            elif self._is_enforced and due in (Step.END_BLOCKED, Step.END_UNENDING):
                self._end(total, due)
        if self._is_enforced:
            self._watch_threads()

    def _watch_threads(self) -> None:
        """End a process that only waits for its other threads, or for a process pool, any longer.

        A program may do other work when its nodes have ended: until it ends, too, nothing is done here.
        """
        waited = 0.0
        while waited < LIMIT:
            time.sleep(LOOK_EVERY)
            if not is_exiting():
                continue
            waited += LOOK_EVERY
            if waited - LOOK_EVERY < REMIND_AFTER <= waited:
                _remind()
        what, way = "; ".join(hindrances()) or "a thread in code outside this program", "give a thread daemon=True"
        if _POOL in what:
            way = "end a pool in on_shutdown: pool.shutdown(wait=False, cancel_futures=True)"
        say(f"ended without cleanup {waited:.0f} s after its nodes: still waiting for {what}; {way}")
        _exit()

    def _ping(self) -> bool:
        """Ask the loop to answer, unless it owes an answer; returns False once the loop is closed."""
        if self._unanswered:
            return not self._loop.is_closed()
        self._unanswered = True
        try:
            self._loop.call_soon_threadsafe(self._answer)
        except RuntimeError:  # the loop is closed
            return False
        return True

    def _answer(self) -> None:
        self._unanswered = False

    def _reads_terminal(self, elapsed: float, silent: float) -> bool:
        """Whether the loop has not run since the signal, and waits for input."""
        return silent == elapsed >= INPUT_AFTER and is_reading(self._main)

    def _interrupt(self, status: int) -> None:
        self._interrupts = Interrupted(status)
        for _ in range(TRIES):
            if hasattr(signal, "pthread_kill"):
                signal.pthread_kill(self._main, self._number)  # which ends a system call as well
            else:
                signal.raise_signal(self._number)
            time.sleep(LAST_SILENCE / TRIES)
            if not self.interrupts:
                return
        self._interrupts = None

    def _remind(self) -> None:
        """Say what the process waits for; what a blocked loop logs, which would hide it, is left out from then on."""
        if self._is_enforced and self._unanswered:
            self._former_level = logging.root.manager.disable
            logging.disable(max(logging.INFO, self._former_level))
        _remind()

    def _place(self) -> str:
        return next(place_of(self._main), "code outside this program")

    def _end(self, elapsed: float, due: Step) -> None:
        from graphflow.runtime.mistakes.unended import catching_lines, left_over  # most programs never need it

        if due is Step.END_BLOCKED:
            codes = [frame.f_code for frame in called_by_loop(stack_of(self._main))]
            what = f"{self._place()} still blocks the event loop"
            if lines := catching_lines(code for code in codes if is_users(code.co_filename)):
                what += f"; {lines} catches what would end it: write except Exception"
        else:
            with suppress(RuntimeError):  # the tasks changed meanwhile
                names = left_over(asyncio.all_tasks(self._loop))
            what = f"still running: {names}" if names else "it did not end"
        say(f"ended without cleanup {elapsed:.0f} s after the signal: {what}")
        _exit()


def say(text: str) -> None:
    """Write a line to stderr by a system call; the terminal may be gone, or `print` be interrupted."""
    with suppress(OSError):
        os.write(2, f"{text}\n".encode())


def _exit() -> NoReturn:
    """End this process, and the workers of its process pools, which would go on without it."""
    multiprocessing = sys.modules.get("multiprocessing")
    for child in multiprocessing.active_children() if multiprocessing is not None else ():
        child.kill()
    _flush()
    os._exit(1)


def _flush() -> None:
    """Flush stdout, unless the main thread holds its lock."""

    def flush() -> None:
        with suppress(OSError, ValueError):
            sys.stdout.flush()

    flushing = threading.Thread(target=flush, daemon=True)
    flushing.start()
    flushing.join(LOOK_EVERY)


def is_exiting() -> bool:
    """Whether the main thread has ended, but for its wait for other threads."""
    outermost = [frame.f_code for frame in stack_of(threading.main_thread().ident or 0)[:1]]
    return [(code.co_filename, code.co_name) for code in outermost] == [(threading.__file__, "_shutdown")]


def is_reading(thread: int) -> bool:
    """Whether a thread is in a call that reads the terminal, such as `input()`."""
    frame = sys._current_frames().get(thread)
    if frame is None or not is_users(frame.f_code.co_filename):
        return False
    positions = list(frame.f_code.co_positions())
    first, last, begin, end = positions[min(frame.f_lasti // 2, len(positions) - 1)]
    if first is None:
        return False
    line = linecache.getline(frame.f_code.co_filename, first).encode()
    return bool(_INPUT.search(line[begin : end if first == last else None].decode(errors="replace")))


def _remind() -> None:
    reasons = [*hindrances()]
    waits = f" (waiting for {'; '.join(reasons)})" if reasons else ""
    say(f"still stopping{waits}; Ctrl-C again ends it without cleanup")


def hindrances() -> Iterator[str]:
    """List the reasons why this process does not end: lines of user code, by thread, and work in process pools."""
    for thread in threading.enumerate():
        if thread.daemon or thread.ident is None or thread.name.startswith("graphflow-"):
            continue
        if type(thread).__name__ == _MANAGER:
            import multiprocessing  # already imported by that thread's pool

            workers = ", ".join(str(child.pid) for child in multiprocessing.active_children())
            yield f"{_POOL}, processes {workers}"
            continue
        place = next(place_of(thread.ident), "")
        if place or not (thread is threading.main_thread() or thread.name.endswith(_ZENOH)):
            yield f"{place or 'code outside this program'}, thread {thread.name!r}"


def place_of(thread: int) -> Iterator[str]:
    """Yield the line of user code that a thread is in, if it is in one."""
    frame = innermost(called_by_loop(stack_of(thread)))
    if frame is not None:
        forgotten = unawaited.forgotten_in(frame.f_code)
        why = f" ({forgotten} is not awaited)" if forgotten else ""
        yield f"{frame.f_code.co_filename}:{frame.f_lineno} in {frame.f_code.co_name}{why}"
