"""Python's logging as ROS 2's: the console's line format and every record published on /rosout.

Source: rcutils' default console format; rcl_interfaces/msg/Log.
"""

from __future__ import annotations

import logging
import sys
import threading
from typing import TYPE_CHECKING, Any

from graphflow.errors import GraphflowError, uncoloured
from graphflow.names import did_you_mean
from graphflow.qos import ROSOUT
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.logs.lately import Lately
from graphflow.runtime.logs.logger import ROOT, keep_loggers
from graphflow.runtime.mistakes import unawaited
from graphflow.runtime.part import Host, Part
from graphflow.times import Time

if TYPE_CHECKING:
    from graphflow.msgs.rcl_interfaces.msg import Log

LEVELS = {logging.DEBUG: 10, logging.INFO: 20, logging.WARNING: 30, logging.ERROR: 40, logging.CRITICAL: 50}
_WORDS = {logging.DEBUG: "DEBUG", logging.INFO: "INFO", logging.WARNING: "WARN", logging.ERROR: "ERROR"}


class ConsoleFormatter(logging.Formatter):
    """ROS 2's line: `[INFO] [1700000000.123456789] [talker]: text`."""

    def format(self, record: logging.LogRecord) -> str:
        name = record.name.removeprefix(f"{ROOT}.")
        word = _WORDS.get(record.levelno, record.levelname if record.levelno < 50 else "FATAL")
        line = f"[{word}] [{record.created:.9f}] [{name}]: {record.getMessage()}"
        if record.exc_info and record.exc_info[0] is not None:
            line += "\n" + self.formatException(record.exc_info)
        return uncoloured(line)


def log_level(word: str) -> int:
    """A logging level by ROS 2's word: debug, info, warn, error or fatal.

    Raises:
        GraphflowError: The word is none of these.
    """
    words = {"debug": 10, "info": 20, "warn": 30, "warning": 30, "error": 40, "fatal": 50}
    if word.lower() not in words:
        raise GraphflowError(f"{word!r} is not a log level{did_you_mean(word.lower(), words)}")
    return words[word.lower()]


class Console(logging.Handler):
    """Writes records to stderr in ROS 2's format, wherever stderr leads at that moment: in a notebook, to the cell.

    Until `is_wanted`, it is the handler of last resort: it writes warnings and errors that no other handler gets.
    Python's own would not, since it takes `Rosout` for a handler that shows them.
    """

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.setFormatter(ConsoleFormatter())
        self.is_wanted = False

    @classmethod
    def installed(cls) -> Console:
        """The one of this process, made when it is first asked for."""
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
        except Exception:  # as in every handler of Python's: logging must not fail its caller
            self.handleError(record)


def _is_shown(record: logging.LogRecord) -> bool:
    """Whether the program has a handler of its own for a record."""
    logger: logging.Logger | None = logging.getLogger(record.name)
    while logger is not None:
        if not all(isinstance(handler, Console | _RosoutHandler) for handler in logger.handlers):
            return True
        logger = logger.parent if logger.propagate else None
    return False


def setup_console(level: int = logging.INFO, *, is_quiet: bool = False) -> None:
    """Write graphflow's log records to stderr in ROS 2's format, and what Python warns of forgotten awaits with them.

    Calling it again only changes the level.

    Args:
        is_quiet: Whether only what is wrong with the program itself is written.
    """
    logging.getLogger("graphflow").setLevel(level)
    unawaited.watch()
    console = Console.installed()
    console.is_wanted = True
    console.setLevel(logging.CRITICAL + 1 if is_quiet else logging.NOTSET)


class _RosoutHandler(logging.Handler):
    """Hands records to `Rosout`. `logging.config` closes every handler that it knows, which must not end the other."""

    def __init__(self, rosout: Rosout) -> None:
        super().__init__()
        self._rosout = rosout

    def emit(self, record: logging.LogRecord) -> None:
        try:
            self._rosout.take(record)
        except Exception:  # as in every handler of Python's: logging must not fail its caller
            self.handleError(record)


class Rosout(Part):
    """Publishes a node's log records on /rosout while the node runs."""

    def __init__(self, host: Host) -> None:
        from graphflow.msgs.rcl_interfaces.msg import Log

        self._host, self._handler = host, _RosoutHandler(self)
        self._thread = 0
        self._publisher = TopicPublisher(host, Log, "/rosout", ROSOUT)
        self._lines, self._lately = 0, Lately()

    @property
    def title(self) -> str:
        return "log"

    def statistics(self) -> dict[str, Any]:
        """Lines that the node has logged, those that were gathered into others, and both a second, lately."""
        log = self._host.log
        gathered, lately = getattr(log, "gathered", 0), getattr(log, "gathered_lately", None)
        rate = self._lately.rate + (0.0 if lately is None else lately.rate)
        return {"lines": self._lines, "gathered": gathered, "rate": rate}

    def open(self) -> None:
        self._thread = threading.get_ident()
        self._publisher.open()
        Console.installed()
        self._host.log.addHandler(self._handler)

    def detach(self) -> None:
        """Stop listening to the node's logger."""
        self._host.log.removeHandler(self._handler)

    def close(self) -> None:
        self.detach()
        self._publisher.close()
        self._host.forget(self)

    def take(self, record: logging.LogRecord) -> None:
        """Publish a record if it is this node's, on the loop; from any thread."""
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
        """Whether this is the nearest node above the record: those of /arm/hand reach the logger of /arm too."""
        logger: logging.Logger | None = logging.getLogger(record.name)
        while logger is not None and not any(isinstance(h, _RosoutHandler) for h in logger.handlers):
            logger = logger.parent
        return logger is None or self._handler in logger.handlers

    def _publish(self, record: logging.LogRecord) -> None:
        if self._host.is_running:
            try:
                self._publisher.publish(to_log(record))
            except Exception:  # as in every handler of Python's: logging must not fail its caller
                self._handler.handleError(record)


def to_log(record: logging.LogRecord) -> Log:
    """A record as rcl_interfaces/msg/Log."""
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
