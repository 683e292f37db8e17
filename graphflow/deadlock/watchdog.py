"""The watchdog: a thread that detects when the event loop is blocked, for how long, and by which line.

It wakes up twice a second. An idle loop is in its selector and is left alone, so that it is not woken up; only a busy
one is pinged, and counts as blocked until it answers.
"""

from __future__ import annotations

import linecache
import logging
import os
import random
import re
import sys
import threading
import time
from asyncio import AbstractEventLoop, BaseEventLoop
from collections import deque
from collections.abc import Callable, Iterable
from contextlib import suppress
from inspect import CO_COROUTINE
from types import CodeType

from graphflow.analysis.frames import Frame, stack_of
from graphflow.analysis.user_code import called_by_loop, innermost, is_ours, is_users, is_users_frame, short_place

logger = logging.getLogger("graphflow")

LOOK_EVERY = 0.5
"""Seconds between two checks of a loop, on average."""
ANSWER_WITHIN = 0.1
"""Seconds after which a busy loop that was pinged counts as blocked."""
REPORT_AFTER = 1.0
"""Seconds after which a loop that the user's code blocks is reported with its stack."""
REPORT_OTHERS_AFTER = 3.0
"""The same where none of the user's code is on the stack: the machine may be overloaded, above all at a start."""
LOOKS, TOO_MANY = 10, 7
"""Checks in a row, and the number of them that must find the loop blocked to be reported, if each block is shorter."""
STACK_SHOWN = 6
"""Lines of the stack in a report, from the user's code inwards."""
_REMEDY = "Await the slow part, or move it to a thread: await self.offload(...)"
_OF_DEF = "Move the slow part to a thread: thread=True where the handler is declared"
"""The same in a `def`, which cannot await."""
_OUTSIDE = "Await the slow part, or move it to a thread: await asyncio.to_thread(...)"
"""The same in code without a node at hand."""
_HELD = "it was stopped, C code held it, or the machine is overloaded"
BLOCKED = "the event loop has been blocked for"
"""The words with which every report of a blocked loop begins."""
_NOTHING_RUNS = "nothing else in this process can run."
_LOCKED = re.compile(r"(?:^with\s+|^)(?P<name>\w+(?:\.\w+)*)(?:\.acquire\(|\s*:)")
"""Pattern of a line that waits for a lock."""
_LOCKS = (type(threading.Lock()), type(threading.RLock()))
_IDLE = ("select", "poll", "_poll", "run_forever", "_run_once", "run_until_complete")
"""Functions in which asyncio's loop waits for events."""
RING_ANYWAY = 4
"""Checks between two pings of a foreign loop that seems idle: a built-in function that blocks it looks the same."""


def _nothing() -> None:
    """Do nothing at a check."""


class Watchdog:
    """The watch over one process's event loop.

    Args:
        blocked: Called on the watching thread, repeatedly, while the loop is blocked.
    """

    def __init__(self, loop: AbstractEventLoop, blocked: Callable[[], None]) -> None:
        self._loop, self._blocked = loop, blocked
        self._loop_thread = threading.get_ident()
        self._ended = threading.Event()
        self._rung_at: float | None = None
        """Time of the ping that the loop has not answered."""
        self._processor_time = 0.0
        """Processor time of this process at that ping, in seconds."""
        self._reported = False
        """Whether the present block was reported."""
        self._resting: tuple[CodeType, int] | None = None
        """Code and instruction at which the thread of a loop not written in Python, such as uvloop's, waits for events:
        its own frames are invisible, so an idle loop can only be recognized by the caller of its callbacks."""
        self._rests = 0
        """Number of checks that found the loop there."""
        self._looks: deque[tuple[str, float]] = deque(maxlen=LOOKS)
        """Results of the last checks: the user's line that blocked the loop, and for how many seconds; an empty line
        if it was not blocked."""
        self._told: set[str] = set()
        """Lines that were reported for blocking the loop often."""
        self.on_look: Callable[[], None] = _nothing
        """Called at each check, on the watching thread."""
        self.late = 0
        """Number of pings that took more than `ANSWER_WITHIN` seconds."""
        self.longest = 0.0
        """Longest time of those, in seconds."""
        self._thread = threading.Thread(target=self._watch, name="graphflow-watchdog", daemon=True)

    def start(self) -> None:
        """Start watching."""
        self._thread.start()

    @property
    def blocked_for(self) -> float:
        """Seconds since an unanswered ping; 0 when the loop answers."""
        rung_at = self._rung_at
        return 0.0 if rung_at is None else time.monotonic() - rung_at

    @property
    def is_blocked(self) -> bool:
        return self.blocked_for > ANSWER_WITHIN

    def _watch(self) -> None:
        began = time.monotonic()
        # At random intervals: a fixed one could beat with a periodic block and always find the loop free.
        while not self._ended.wait(pause := LOOK_EVERY * random.uniform(0.5, 1.5)):  # noqa: S311
            # This thread needs only the GIL and a processor: if it is late, nothing else could run either.
            lost = time.monotonic() - began - pause
            if lost > REPORT_AFTER:
                logger.warning("nothing in this process could run for %.1f s: %s", lost, _HELD)
            self.on_look()
            if self._is_busy():
                self._ping()
            else:
                self._looks.append(("", 0.0))
            began = time.monotonic()

    def _is_busy(self) -> bool:
        """Whether the loop may be doing something right now."""
        if not self._loop.is_running():  # stopped, and perhaps resumed later
            return False
        frame = sys._current_frames().get(self._loop_thread)
        if frame is not None and (frame.f_code, frame.f_lasti) == self._resting:
            self._rests += 1
            return self._rests % RING_ANYWAY == 0
        return frame is not None and frame.f_code.co_name not in _IDLE

    def _ping(self) -> None:
        """Ping the loop, and wait for its answer; report it if that takes long."""
        answered = threading.Event()
        self._rung_at, self._processor_time = time.monotonic(), time.process_time()
        try:
            self._loop.call_soon_threadsafe(self._answer, answered)
        except RuntimeError:  # the loop is closed
            self._rung_at = None
            return
        place = ""
        while not answered.wait(ANSWER_WITHIN) and not self._ended.is_set():
            place = self._place()
            self._blocked()
            if self.blocked_for >= REPORT_AFTER and not self._reported:
                self._report()
        took = self.blocked_for
        self._rung_at = None
        if took > ANSWER_WITHIN:
            self.late += 1
            self.longest = max(self.longest, took)
        if self._reported:
            self._reported = False
            self._looks.clear()
            logger.warning("the event loop runs again after %.1f s", took)
        else:
            self._count_short(place, took)

    def _answer(self, answered: threading.Event) -> None:
        """Answer a ping. Runs on the loop."""
        caller = sys._getframe().f_back
        if caller is not None and not isinstance(self._loop, BaseEventLoop):
            self._resting = caller.f_code, caller.f_lasti
        answered.set()

    def _count_short(self, place: str, took: float) -> None:
        """Report short blocks if nearly every check finds one."""
        self._looks.append((place, took))
        blocked = [place for place, _ in self._looks if place]
        if len(blocked) < TOO_MANY:
            return
        longest = max(took for place, took in self._looks if place)
        self._looks.clear()
        most = max(blocked, key=blocked.count)
        if most not in self._told:
            self._told.add(most)
            text = "the event loop was blocked in %d of %d checks, for up to %.1f s at a time, mostly in %s: %s"
            logger.warning(text, len(blocked), LOOKS, longest, most, _REMEDY)

    def _place(self) -> str:
        """Return the user's line that the loop's thread is in; empty if it is in none."""
        frame = innermost(called_by_loop(stack_of(self._loop_thread)))
        return "" if frame is None else f"{frame.f_code.co_filename}:{frame.f_lineno} in {frame.f_code.co_name}"

    def _report(self) -> None:
        """Report a loop that is blocked now, with the stack from the user's code inwards."""
        stack = stack_of(self._loop_thread)
        frames = called_by_loop(stack)
        files = [frame.f_code.co_filename for frame in frames]
        shown = [f"{frame.f_code.co_filename}:{frame.f_lineno} in {frame.f_code.co_name}" for frame in frames]
        begun = 0
        if len(frames) == len(stack):  # no loop is to be seen: the frames before graphflow's have started it
            begun = next((i for i, file in enumerate(files) if is_ours(file)), 0)
        last = max((i for i, frame in enumerate(frames) if i >= begun and is_users_frame(frame)), default=-1)
        seconds = self.blocked_for
        if last < 0 and seconds < REPORT_OTHERS_AFTER:
            return
        self._reported = True
        above = next((i for i, file in enumerate(files) if is_users(file)), 0)  # skips asyncio's own frames
        first = max((i + 1 for i, file in enumerate(files[: last + 1]) if is_ours(file)), default=above)
        if last < 0:
            level, text = _of_others(seconds, time.process_time() - self._processor_time)
        else:
            blocked = f"{BLOCKED} {seconds:.1f} s in {shown[last]}: {_NOTHING_RUNS}"
            way = _of_lock(frames[last]) or _of_loop(frames[last]) or _remedy(frames)
            level, text = logging.ERROR, f"{blocked}\n{way}"
            end = next((i for i, file in enumerate(files) if i > last and is_ours(file)), len(files))
            shown = shown[:end]  # without what a short call of graphflow's was doing
        lines = "".join(f"\n  {place}" for place in shown[first:][-STACK_SHOWN:])
        logger.log(level, "%s%s", text, lines)

    @property
    def is_closed(self) -> bool:
        """Whether the watchdog was stopped."""
        return self._ended.is_set()

    def close(self) -> None:
        """Stop watching."""
        self._ended.set()


def _remedy(frames: Iterable[Frame]) -> str:
    users = [frame for frame in frames if is_users_frame(frame)]
    if not any("self" in frame.f_locals for frame in users):
        return _OUTSIDE
    return _REMEDY if any(frame.f_code.co_flags & CO_COROUTINE for frame in users) else _OF_DEF


def _of_loop(frame: Frame) -> str:
    """Return the line and remedy of a loop in a frame's function that cannot but block; "" if it has none."""
    from graphflow.analysis.mistakes.calls.blocking_async import blocking_async  # most programs never need it
    from graphflow.analysis.syntax import syntax_of

    file, lines = frame.f_code.co_filename, {line for *_, line in frame.f_code.co_lines()}
    with suppress(OSError, SyntaxError, ValueError):  # its source is not available
        found = [(line, text) for line, text in blocking_async(syntax_of(file).module) if line in lines]
        return next((f"{short_place(file, line)}: {text}" for line, text in found), "")
    return ""


def _of_others(seconds: float, processor_time: float) -> tuple[int, str]:
    """Return the level and text of a report where the loop's thread is in none of the user's code.

    Args:
        seconds: Time since the ping that the loop has not answered.
        processor_time: Processor time that the process got meanwhile, in seconds.
    """
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0
    if processor_time < seconds / 2 and load > (os.cpu_count() or 1):
        return logging.WARNING, (
            f"the event loop has not run for {seconds:.1f} s, in which this process got {processor_time:.1f} s of "
            f"processor time; the machine seems to be overloaded, with a load average of {load:.1f}"
        )
    blocked = f"{BLOCKED} {seconds:.1f} s, with no line of this program on its stack"
    return logging.ERROR, f"{blocked}: {_NOTHING_RUNS}"


def _of_lock(frame: Frame) -> str:
    """Return the remedy for a `threading` lock that the loop waits for in a line; empty for any other wait."""
    line = linecache.getline(frame.f_code.co_filename, frame.f_lineno).strip()
    found = _LOCKED.match(line)
    if found is None:
        return ""
    first, *rest = found["name"].split(".")
    thing = {**frame.f_globals, **frame.f_locals}.get(first)
    for part in rest:  # by `__dict__`, since `getattr` could run a property of the user's
        thing = getattr(thing, "__dict__", {}).get(part)
    if not isinstance(thing, _LOCKS):
        return ""
    return (
        f"{found['name']} is a lock of threads, for which all handlers wait here; one that is held across an await "
        "ends in this for ever: use asyncio.Lock() and async with, or give the handlers one group=Group(1)"
    )
