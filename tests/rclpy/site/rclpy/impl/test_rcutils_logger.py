"""A node's logger."""

from __future__ import annotations

import logging
import time
from typing import Any

import pytest

from rclpy.clock import ROSClock
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.time import Time


class Lines(logging.Handler):
    """Keeps what is logged."""

    def __init__(self) -> None:
        super().__init__()
        self.records: list[logging.LogRecord] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.records.append(record)


def test_a_line_says_where_it_was_logged() -> None:
    """In which function, and on which line."""
    logger, lines = RcutilsLogger("test.place"), Lines()
    logger._logger.addHandler(lines)
    assert logger.warning("all %d of it", name="test.place")
    record = lines.records[0]
    assert record.getMessage() == "all %d of it"
    assert (record.levelname, record.funcName) == ("WARNING", "test_a_line_says_where_it_was_logged")
    assert record.pathname == __file__
    logger._logger.removeHandler(lines)


def test_only_what_matters_is_logged() -> None:
    """By the logger's level, or the nearest above it."""
    logger = RcutilsLogger("test.level")
    child = logger.get_child("child")
    assert (logger.debug("no"), logger.info("yes")) == (False, True)
    logger.set_level(LoggingSeverity.ERROR)
    assert not child.warn("no")
    assert child.error("yes")
    assert child.fatal("yes")
    assert child.get_effective_level() is LoggingSeverity.ERROR
    with pytest.raises(ValueError, match="must not be empty"):
        logger.get_child("")


def repeat(**options: Any) -> list[bool]:
    logger = RcutilsLogger("test.repeat")
    return [logger.info("line", **options) for _ in range(3)]


def test_a_line_may_be_logged_once_or_not_at_first() -> None:
    """Or both: the second time only."""
    assert repeat(once=True) == [True, False, False]


def test_a_line_may_be_left_out_at_first() -> None:
    """And then be logged, once if that is wanted too."""
    logger = RcutilsLogger("test.skip")
    assert [logger.info("line", skip_first=True) for _ in range(3)] == [False, True, True]
    assert [logger.info("line", skip_first=True, once=True) for _ in range(3)] == [False, True, False]


def test_a_line_may_be_throttled_by_a_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of one's own, or by the time of day."""
    logger, clock = RcutilsLogger("test.throttle"), ROSClock()
    clock._set_ros_time_is_active(True)
    logged = []
    for seconds in (10.0, 10.5, 11.0, 11.9):
        clock.set_ros_time_override(Time(seconds=seconds))
        logged.append(logger.info("line", throttle_duration_sec=1.0, throttle_time_source_type=clock))
    assert logged == [True, False, True, False]
    logged = []
    for milliseconds in (1000, 1020, 1040):
        monkeypatch.setattr(time, "time_ns", lambda: milliseconds * 1_000_000)  # noqa: B023 - called at once
        logged.append(logger.info("line", throttle_duration_sec=0.03))
    assert logged == [True, False, True]


def test_what_a_call_says_of_itself_does_not_change() -> None:
    """And is what there is to say."""
    logger = RcutilsLogger("test.change")
    with pytest.raises(ValueError, match="parameters cannot be changed"):
        for seconds in (1, 2):
            logger.info("line", throttle_duration_sec=seconds)
    with pytest.raises(ValueError, match="severity cannot be changed"):
        for severity in (LoggingSeverity.INFO, LoggingSeverity.WARN):
            logger.log("line", severity)
    with pytest.raises(ValueError, match="name cannot be changed"):
        for name in "ab":
            logger.info("line", name=name)
    with pytest.raises(TypeError, match="required parameter"):
        logger.info("line", throttle_time_source_type=ROSClock())
    with pytest.raises(TypeError, match="throttle_duration_sec: expected a number of seconds, got '1'"):
        logger.info("line", throttle_duration_sec="1")
    with pytest.raises(TypeError, match="not one of the recognized"):
        logger.info("line", loudly=True)
