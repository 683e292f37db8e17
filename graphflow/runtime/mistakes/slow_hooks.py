"""Slow hooks of a node: a warning with the line where they wait, and their consequences."""

from __future__ import annotations

import asyncio
import logging
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import PurePath

from graphflow.analysis.frames import stack_of
from graphflow.analysis.user_code import innermost
from graphflow.deadlock.startup_waits import place_of
from graphflow.errors import Place
from graphflow.executor.clock import Alarm
from graphflow.runtime.part import Host
from graphflow.times import to_ns

logger = logging.getLogger("graphflow")

SLOW_INIT = 3.0
"""Seconds that an `__init__` may take before it is reported."""
SLOW = 5.0
"""Seconds that a hook may take before it is reported."""
_BEGINNINGS = ("on_start", "on_configure", "on_activate")
"""Hooks before which no handler runs."""
_NO_HANDLERS = (
    "no handler of this node runs until it returns: move its loops, and waits for them or for later nodes, into a @task"
)
_ELSEWHERE = "long or repeated work belongs in on_start, a @timer or a @task"
_NO_TRANSITION = "until then, the node can make no other transition"


def when_slow(host: Host, hook: str) -> Alarm:
    """Warn with the line where the current task's hook waits, unless the caller cancels the alarm in time."""
    task, clock = asyncio.current_task(), host.context.clock
    then = _NO_HANDLERS if hook in _BEGINNINGS else _NO_TRANSITION

    def warn() -> None:
        host.log.warning("%s has not returned for %.0f s %s; %s", hook, SLOW, place_of(task), then)

    return clock.call_at(clock.monotonic_ns() + to_ns(SLOW), warn)


@contextmanager
def warn_slow_init(cls: type) -> Iterator[None]:
    """Warn with the current line if the block, which makes a node, takes long. On an event loop, the watchdog does."""
    thread = threading.get_ident()

    def warn() -> None:
        frame = innermost(stack_of(thread))
        if frame is None:
            return
        place = Place(PurePath(frame.f_code.co_filename).name, frame.f_lineno)
        logger.warning(
            "%s.__init__ has not returned for %.0f s, now in %s in %s, and the node starts when it has: %s",
            *(cls.__name__, SLOW_INIT, place, frame.f_code.co_name, _ELSEWHERE),
        )

    timer = threading.Timer(SLOW_INIT, warn)
    timer.daemon = True
    if not _is_on_loop():
        timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _is_on_loop() -> bool:
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return False
    return True
