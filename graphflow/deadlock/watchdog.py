"""Watches the event loop from a thread: how long it has not come round, and what keeps it.

Looking costs a wake-up twice a second. An idle loop waits in its selector and is left alone; only one that is found
busy is pinged, and counts as blocked when it does not answer.
"""

from __future__ import annotations

import linecache
import logging
import random
import re
import sys
import threading
import time
from asyncio import AbstractEventLoop, BaseEventLoop
from collections import deque
from collections.abc import Callable
from types import CodeType

from graphflow.analysis.frames import Frame, stack_of
from graphflow.analysis.user_code import called_by_loop, innermost, is_ours, is_users

logger = logging.getLogger("graphflow")

LOOK_EVERY = 0.5
"""Seconds between two looks at a loop that is idle, on average."""
ANSWER_WITHIN = 0.1
"""Seconds after which a busy loop that was pinged counts as late."""
REPORT_AFTER = 1.0
"""Seconds after which a blocked loop is reported with its stack."""
LOOKS, TOO_MANY = 10, 7
"""Of so many looks in a row, how many that find the loop blocked, each for a shorter time, are reported."""
STACK_SHOWN = 6
"""Lines of that stack, from the user's code inwards."""
_REMEDY = "Await what takes long, or move it to a thread: thread=True, or await self.offload(...)"
_LOCKED = re.compile(r"(?:^with\s+|^)(?P<name>\w+(?:\.\w+)*)(?:\.acquire\(|\s*:)")
"""A line that waits for a lock."""
_LOCKS = (type(threading.Lock()), type(threading.RLock()))
_IDLE = ("select", "poll", "_poll", "run_forever", "_run_once", "run_until_complete")
"""Functions in which asyncio's loop waits for something to happen."""
RING_ANYWAY = 4
"""Every so many looks a loop that seems to idle is pinged, where a built-in function that blocks it looks the same."""


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
        self._reported = False
        self._resting: tuple[CodeType, int] | None = None
        """The place in Python from which a loop that is not written in it, such as uvloop's, calls back, and in which
        its thread stays while it waits."""
        self._rests = 0
        """How often the loop was found there."""
        self._looks: deque[tuple[str, float]] = deque(maxlen=LOOKS)
        """The line of the user's in which each of the last looks has found the loop blocked, and for how many seconds;
        an empty line for those that did not."""
        self._told: set[str] = set()
        """The lines that were reported."""
        self.late = 0
        """How often the loop has taken more than `ANSWER_WITHIN` seconds to come round."""
        self.longest = 0.0
        """The longest of those times, in seconds."""
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
        # At random, since a loop may be free for a moment just as often.
        while not self._ended.wait(pause := LOOK_EVERY * random.uniform(0.5, 1.5)):  # noqa: S311
            held = time.monotonic() - began - pause
            if held > REPORT_AFTER:
                logger.warning("nothing in this process could run for %.1f s: it was stopped, or C code held it", held)
            if self._is_busy():
                self._ring_and_wait()
            else:
                self._looks.append(("", 0.0))
            began = time.monotonic()

    def _is_busy(self) -> bool:
        """Whether the loop is doing something right now."""
        if not self._loop.is_running():  # it has been stopped, and may go on later
            return False
        frame = sys._current_frames().get(self._loop_thread)
        if frame is not None and (frame.f_code, frame.f_lasti) == self._resting:
            self._rests += 1
            return self._rests % RING_ANYWAY == 0
        return frame is not None and frame.f_code.co_name not in _IDLE

    def _ring_and_wait(self) -> None:
        answered = threading.Event()
        self._rung_at = time.monotonic()
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
                self._reported = True
                logger.error("%s", self._stack())
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
            self._add_up(place, took)

    def _answer(self, answered: threading.Event) -> None:
        """Runs on the loop."""
        caller = sys._getframe().f_back
        if caller is not None and not isinstance(self._loop, BaseEventLoop):
            self._resting = caller.f_code, caller.f_lasti
        answered.set()

    def _add_up(self, place: str, took: float) -> None:
        """Tell of blocks that are short, and of which there is one nearly whenever the loop is looked at."""
        self._looks.append((place, took))
        blocked = [place for place, _ in self._looks if place]
        if len(blocked) < TOO_MANY:
            return
        longest = max(took for place, took in self._looks if place)
        self._looks.clear()
        most = max(blocked, key=blocked.count)
        if most not in self._told:
            self._told.add(most)
            text = "the event loop was blocked at %d of %d looks, for up to %.1f s at a time, mostly in %s: %s"
            logger.warning(text, len(blocked), LOOKS, longest, most, _REMEDY)

    def _place(self) -> str:
        """The user's line in which the loop's thread is; empty if it is in none."""
        frame = innermost(called_by_loop(stack_of(self._loop_thread)))
        return "" if frame is None else f"{frame.f_code.co_filename}:{frame.f_lineno} in {frame.f_code.co_name}"

    def _stack(self) -> str:
        frames = called_by_loop(stack_of(self._loop_thread))
        files = [frame.f_code.co_filename for frame in frames]
        shown = [f"{frame.f_code.co_filename}:{frame.f_lineno} in {frame.f_code.co_name}" for frame in frames]
        begun = next((i for i, file in enumerate(files) if is_ours(file)), 0)  # before it is what has started graphflow
        last = max((i for i, file in enumerate(files) if i >= begun and is_users(file)), default=-1)
        above = next((i for i, file in enumerate(files) if is_users(file)), 0)  # asyncio's own come first
        first = max((i + 1 for i, file in enumerate(files[: last + 1]) if is_ours(file)), default=above)
        where = f" in {shown[last]}" if last >= 0 else ""
        remedy = _of_lock(frames[last]) or _REMEDY if last >= 0 else _REMEDY
        stack = "".join(f"\n  {place}" for place in shown[first:][-STACK_SHOWN:])
        return (
            f"the event loop has been blocked for {self.blocked_for:.1f} s{where}: nothing else in this process can "
            f"run.\n{remedy}{stack}"
        )

    @property
    def is_closed(self) -> bool:
        """Whether it has been told to stop watching."""
        return self._ended.is_set()

    def close(self) -> None:
        """Stop watching."""
        self._ended.set()


def _of_lock(frame: Frame) -> str:
    """What to do about a lock of threads that the loop waits for in a line; empty if it waits for something else."""
    line = linecache.getline(frame.f_code.co_filename, frame.f_lineno).strip()
    found = _LOCKED.match(line)
    if found is None:
        return ""
    first, *rest = found["name"].split(".")
    thing = {**frame.f_globals, **frame.f_locals}.get(first)
    for part in rest:  # without running any code of the user's
        thing = getattr(thing, "__dict__", {}).get(part)
    if not isinstance(thing, _LOCKS):
        return ""
    return (
        f"{found['name']} is a lock of threads, for which all handlers wait here; one that is held across an await "
        "ends in this for ever: use asyncio.Lock() and async with, or give the handlers one group=Group(1)"
    )
