"""A node's logger: Python's, with ROS 2's `throttle` and `once`, one-line format errors, and flood control."""

from __future__ import annotations

import logging
import sys
import threading
import time
from collections.abc import Mapping
from pathlib import Path
from types import CodeType
from typing import TYPE_CHECKING, Any

from graphflow.runtime.logs.lately import Lately

ROOT = "graphflow.node"
FREE = 10
"""Warnings and errors that one line of code may log in a second without aggregation."""
WINDOW = 1.0
"""Seconds between two aggregated records."""
PLACES = 1000
"""Lines of code tracked."""

_HERE = str(Path(__file__).parents[1])
_Site = tuple[CodeType, int]


class _Flow:
    """The recent records of one line of code."""

    __slots__ = ("count", "is_flood", "level", "since", "unsaid")

    def __init__(self, since: float) -> None:
        self.since, self.count, self.unsaid, self.is_flood, self.level = since, 0, 0, False, 0


class OwnLogger(logging.Logger):
    """A logger of graphflow that stays enabled when libraries configure logging.

    `logging.config` disables the loggers that a configuration does not name, unless told otherwise; here it does
    not. Records on graphflow's console are not repeated by a handler that `basicConfig` has installed.
    """

    @property
    def disabled(self) -> bool:
        """Whether the program has disabled the logger."""
        return bool(self.__dict__.get("_is_disabled"))

    @disabled.setter
    def disabled(self, value: bool) -> None:
        if sys._getframe(1).f_globals.get("__name__") != "logging.config":
            self.__dict__["_is_disabled"] = value

    def callHandlers(self, record: logging.LogRecord) -> None:  # noqa: N802 - its name is Python's
        if not any(getattr(handler, "is_wanted", False) for handler in logging.getLogger("graphflow").handlers):
            super().callHandlers(record)
            return
        logger: logging.Logger | None = self
        while logger is not None:
            is_above = not f"{logger.name}.".startswith("graphflow.")
            for handler in logger.handlers:
                if record.levelno >= handler.level and not (is_above and _is_terminal(handler)):
                    handler.handle(record)
            logger = logger.parent if logger.propagate else None


def _is_terminal(handler: logging.Handler) -> bool:
    """Whether a handler writes to the process's standard streams."""
    streams = (sys.stderr, sys.stdout, sys.__stderr__, sys.__stdout__)
    return isinstance(handler, logging.StreamHandler) and handler.stream in streams


def keep_loggers() -> None:
    """Turn graphflow's existing loggers into `OwnLogger`s."""
    for name, logger in list(logging.Logger.manager.loggerDict.items()):
        if type(logger) is logging.Logger and f"{name}.".startswith("graphflow."):
            logger.__class__ = OwnLogger


class NodeLogger(OwnLogger):
    """The logger of one node.

    `throttle=1.0` logs a line at most once a second, `once=True` once, `skip_first=True` from the second time on.
    Warnings and errors from one line of code beyond `FREE` a second are aggregated: one a second is logged, with the
    number of those left out.
    """

    def __init__(self, name: str, level: int = logging.NOTSET) -> None:
        super().__init__(name, level)
        self._last: dict[_Site, float] = {}
        self._flows: dict[_Site, _Flow] = {}
        self._lock = threading.Lock()
        self.gathered = 0
        """Records that were counted instead of logged."""
        self.gathered_lately = Lately()

    if TYPE_CHECKING:  # the keywords that Python's own methods pass on to `_log`

        def debug(
            self,
            msg: object,
            *args: object,
            throttle: float = 0.0,
            once: bool = False,
            skip_first: bool = False,
            **options: Any,
        ) -> None: ...

        info = warning = error = critical = exception = debug

    def _log(
        self,
        level: int,
        msg: object,
        args: Any,
        exc_info: Any = None,
        extra: Mapping[str, object] | None = None,
        stack_info: bool = False,
        stacklevel: int = 1,
        *,
        throttle: float = 0.0,
        once: bool = False,
        skip_first: bool = False,
        **unknown: object,
    ) -> None:
        if unknown:
            word = next(iter(unknown))
            hint = "; in graphflow it is throttle=1.0" if word.startswith("throttle") else ""
            raise TypeError(f"a node's logger takes throttle, once and skip_first, not {word!r}{hint}")
        frame = sys._getframe(1 + stacklevel)
        site = (frame.f_code, frame.f_lineno)
        if (throttle or once or skip_first) and not self._is_due(site, throttle, once=once, skip_first=skip_first):
            return
        is_users = not frame.f_code.co_filename.startswith(_HERE)  # records of the runtime count for the runtime's line
        more = self._gathered(site, level) if level >= logging.WARNING and is_users else ""
        if more is None:
            return
        if args:
            msg, args = _fitted(msg, args, site)
        if more:
            msg, args = f"{msg % args if args else msg}{more}", ()
        super()._log(level, msg, args, exc_info, extra, stack_info, stacklevel + 1)

    def _is_due(self, site: _Site, throttle: float, *, once: bool, skip_first: bool) -> bool:
        now = time.monotonic()
        with self._lock:
            last = self._last.get(site)
            if last is None and len(self._last) < PLACES:
                self._last[site] = now if not skip_first else now - throttle
            if last is None:
                return not skip_first
            if (once and not skip_first) or now - last < throttle:
                return False
            self._last[site] = float("inf") if once else now
            return last != float("inf")

    def _gathered(self, site: _Site, level: int) -> str | None:
        """Return the suffix of a record to log, or None for one that is only counted."""
        now = time.monotonic()
        with self._lock:
            flow = self._flows.get(site)
            if flow is None:
                if len(self._flows) >= PLACES:
                    return ""
                flow = self._flows[site] = _Flow(now)
            flow.level = level
            if now - flow.since >= WINDOW:
                unsaid = flow.unsaid
                flow.is_flood = flow.count > FREE
                flow.since, flow.count, flow.unsaid = now, 1, 0
                return f" ({unsaid} more like this in between)" if unsaid else ""
            flow.count += 1
            if flow.count > FREE or flow.is_flood:
                flow.unsaid += 1
                self.gathered += 1
                self.gathered_lately.note()
                return None
            return ""

    def log_suppressed(self) -> None:
        """Log the number of records counted since the last report."""
        with self._lock:
            flows = [(site, flow.unsaid, flow.level) for site, flow in self._flows.items() if flow.unsaid]
            for flow in self._flows.values():
                flow.unsaid = 0
        for (code, line), unsaid, level in flows:
            super()._log(level, f"{unsaid} more lines from {code.co_filename}:{line} were not shown", (), stacklevel=2)


def _fitted(msg: object, args: object, site: _Site) -> tuple[object, Any]:
    """Return a text and its values; where they do not match, one line that reports it in place of a traceback."""
    try:
        str(msg) % args
    except (TypeError, ValueError, KeyError) as error:
        values = ", ".join(repr(value)[:200] for value in (args if isinstance(args, tuple) else (args,)))
        code, line = site
        where = f"{code.co_filename}:{line}"
        return f"{msg} {values} ({where}: {error}; write %s in the text for each value, or use an f-string)", ()
    return msg, args


def node_logger(full_name: str) -> NodeLogger:
    """Return the logger of the node `full_name`: `/turtle1/follower` logs as `turtle1.follower`."""
    name = f"{ROOT}.{full_name[1:].replace('/', '.')}"
    manager = logging.Logger.manager
    # For this call only: `logging.setLoggerClass` would be for all loggers that the program makes.
    former, manager.loggerClass = manager.loggerClass, NodeLogger
    try:
        found = logging.getLogger(name)
    finally:
        manager.loggerClass = former
    assert isinstance(found, NodeLogger), f"{name} was made by other code first"
    return found
