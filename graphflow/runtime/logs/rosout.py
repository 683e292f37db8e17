"""Python's logging in ROS 2's form: the console's line format, and records on /rosout.

Source: rcutils' default console format; rcl_interfaces/msg/Log.
"""

from __future__ import annotations

import logging
import sys
import threading
from typing import TYPE_CHECKING

from graphflow.errors import GraphflowError, uncoloured
from graphflow.names import did_you_mean
from graphflow.qos import ROSOUT
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.logs.lately import Lately
from graphflow.runtime.logs.logger import ROOT, NodeLogger, keep_loggers
from graphflow.runtime.mistakes import unawaited
from graphflow.runtime.part import Host, Part
from graphflow.times import Time

if TYPE_CHECKING:
    from graphflow.msgs.rcl_interfaces.msg import Log

LEVELS = {logging.DEBUG: 10, logging.INFO: 20, logging.WARNING: 30, logging.ERROR: 40, logging.CRITICAL: 50}
_WORDS = {logging.DEBUG: "DEBUG", logging.INFO: "INFO", logging.WARNING: "WARN", logging.ERROR: "ERROR"}


class ConsoleFormatter(logging.Formatter):
    """A formatter with ROS 2's line format: `[INFO] [1700000000.123456789] [talker]: text`."""

    def format(self, record: logging.LogRecord) -> str:
        name = record.name.removeprefix(f"{ROOT}.")
        word = _WORDS.get(record.levelno, record.levelname if record.levelno < 50 else "FATAL")
        line = f"[{word}] [{record.created:.9f}] [{name}]: {record.getMessage()}"
        if record.exc_info and record.exc_info[0] is not None:
            line += "\n" + self.formatException(record.exc_info)
        return uncoloured(line)


def log_level(word: str) -> int:
    """Convert ROS 2's name of a log level (debug, info, warn, error, fatal) to Python's number.

    Raises:
        GraphflowError: The name is not one of these.
    """
    words = {"debug": 10, "info": 20, "warn": 30, "warning": 30, "error": 40, "fatal": 50}
    if word.lower() not in words:
        raise GraphflowError(f"{word!r} is not a log level{did_you_mean(word.lower(), words)}")
    return words[word.lower()]


class Console(logging.Handler):
    """A handler that writes ROS 2's lines to the current stderr; in a notebook, that is the cell's.

    Until `is_wanted`, it is the handler of last resort: it writes warnings and errors that no other handler receives.
    Python's own does not, since it counts `Rosout` as a handler.
    """

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.setFormatter(ConsoleFormatter())
        self.is_wanted = False

    @classmethod
    def installed(cls) -> Console:
        """Return the process's console; created on first use."""
        logger = logging.getLogger("graphflow")
        keep_loggers()
        for handler in logger.handlers:
            if isinstance(handler, cls):
                return handler
        console = cls()
        logger.addHandler(console)
        return console

    def emit(self, record: logging.LogRecord) -> None:
        if not self.is_wanted and _is_shown(record):
            return
        try:
            sys.stderr.write(f"{self.format(record)}\n")
            sys.stderr.flush()
        except Exception:  # as in Python's own handlers: logging must not fail its caller
            self.handleError(record)


def _is_shown(record: logging.LogRecord) -> bool:
    """Whether the program has installed a handler that shows a record."""
    logger: logging.Logger | None = logging.getLogger(record.name)
    while logger is not None:
        if not all(isinstance(handler, Console | _RosoutHandler) for handler in logger.handlers):
            return True
        logger = logger.parent if logger.propagate else None
    return False


def setup_console(level: int = logging.INFO, *, is_quiet: bool = False) -> None:
    """Write graphflow's log records and Python's warnings of forgotten awaits to stderr in ROS 2's format.

    Later calls only change the level.

    Args:
        is_quiet: Whether to write only problems of the program itself.
    """
    logging.getLogger("graphflow").setLevel(level)
    unawaited.watch()
    console = Console.installed()
    console.is_wanted = True
    console.setLevel(logging.CRITICAL + 1 if is_quiet else logging.NOTSET)


class _RosoutHandler(logging.Handler):
    """A handler that passes records to `Rosout`; `logging.config` may close it without closing the publisher."""

    def __init__(self, rosout: Rosout) -> None:
        super().__init__()
        self._rosout = rosout

    def emit(self, record: logging.LogRecord) -> None:
        try:
            self._rosout.take(record)
        except Exception:  # as in Python's own handlers: logging must not fail its caller
            self.handleError(record)


class Rosout(Part):
    """The publisher of a node's log records on /rosout while the node runs."""

    def __init__(self, host: Host) -> None:
        from graphflow.msgs.rcl_interfaces.msg import Log

        self._host, self._handler = host, _RosoutHandler(self)
        self._thread = 0
        self._publisher = TopicPublisher(host, Log, "/rosout", ROSOUT)
        self._lines, self._lately = 0, Lately()

    @property
    def title(self) -> str:
        return "log"

    def statistics(self) -> dict[str, object]:
        """Return the numbers of records logged and aggregated, and the recent rates of both per second."""
        log = self._host.log
        gathered, lately = (log.gathered, log.gathered_lately.rate) if isinstance(log, NodeLogger) else (0, 0.0)
        rate = self._lately.rate + lately
        return {"lines": self._lines, "gathered": gathered, "rate": rate}

    def open(self) -> None:
        self._thread = threading.get_ident()
        self._publisher.open()
        Console.installed()
        self._host.log.addHandler(self._handler)

    def detach(self) -> None:
        """Stop receiving the logger's records."""
        self._host.log.removeHandler(self._handler)

    def close(self) -> None:
        self.detach()
        self._publisher.close()
        self._host.forget(self)

    def take(self, record: logging.LogRecord) -> None:
        """Publish a record, if it is this node's, on the loop; from any thread."""
        if not self._host.is_running or not self._is_ours(record):
            return
        self._lines += 1
        self._lately.note()
        loop = self._host.context.loop
        if threading.get_ident() == self._thread:
            self._publish(record)
        elif not loop.is_closed():
            loop.call_soon_threadsafe(self._publish, record)

    def _is_ours(self, record: logging.LogRecord) -> bool:
        """Whether this node's logger is the nearest: /arm's logger also receives /arm/hand's records."""
        logger: logging.Logger | None = logging.getLogger(record.name)
        while logger is not None and not any(isinstance(h, _RosoutHandler) for h in logger.handlers):
            logger = logger.parent
        return logger is None or self._handler in logger.handlers

    def _publish(self, record: logging.LogRecord) -> None:
        if self._host.is_running:
            try:
                self._publisher.publish(to_log(record))
            except Exception:  # as in Python's own handlers: logging must not fail its caller
                self._handler.handleError(record)


def to_log(record: logging.LogRecord) -> Log:
    """Convert a record to a rcl_interfaces/msg/Log."""
    from graphflow.msgs.rcl_interfaces.msg import Log

    return Log(
        stamp=Time(int(record.created * 1e9)),
        level=LEVELS.get(record.levelno, 20),
        name=record.name.removeprefix(f"{ROOT}."),
        msg=record.getMessage(),
        file=record.pathname,
        function=record.funcName or "",
        line=record.lineno,
    )
