"""A node's logger: throttled, once, wrong calls in a line, floods gathered."""

from __future__ import annotations

import itertools
import logging
import time

import pytest

from graphflow.runtime.logs.logger import FREE, NodeLogger, node_logger

_number = itertools.count()


@pytest.fixture
def log() -> NodeLogger:
    return node_logger(f"/logged/number{next(_number)}")


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    return now


def test_throttle(log: NodeLogger, clock: list[float], caplog: pytest.LogCaptureFixture) -> None:
    """At most once in its seconds, each line of code by itself."""
    caplog.set_level(logging.INFO, log.name)
    for i in range(25):
        clock[0] = 100 + i / 10
        log.info("a %d", i, throttle=1.0)
        log.info("b", throttle=2.0)
    assert caplog.messages == ["a 0", "b", "a 10", "a 20", "b"]


def test_once_and_skip_first(log: NodeLogger, clock: list[float], caplog: pytest.LogCaptureFixture) -> None:
    """As in ROS 2."""
    caplog.set_level(logging.INFO, log.name)
    for i in range(4):
        log.info("once", once=True)
        log.info("skip %d", i, skip_first=True)
        log.info("both %d", i, once=True, skip_first=True)
        log.info("late %d", i, throttle=5.0, skip_first=True)
    assert caplog.messages == ["once", "skip 1", "both 1", "late 1", "skip 2", "skip 3"]


def test_a_word_of_rclpy(log: NodeLogger) -> None:
    """The error has graphflow's name for it."""
    with pytest.raises(TypeError, match=r"not 'throttle_duration_sec'; in graphflow it is throttle=1.0"):
        log.warning("x", throttle_duration_sec=1.0)


def test_values_without_a_place(log: NodeLogger, caplog: pytest.LogCaptureFixture) -> None:
    """One line with the values and the place, in place of a page."""
    log.error("e", 3.5)
    log.error("%d m", "far")
    first, second = caplog.messages
    assert first.startswith(f"e 3.5 ({__file__}:")
    assert first.endswith("write %s in the text for each value, or use an f-string)")
    assert "%d m 'far'" in second


def test_the_place_is_the_callers(log: NodeLogger, caplog: pytest.LogCaptureFixture) -> None:
    """As Python's own logger has it."""
    log.warning("x")
    assert caplog.records[0].pathname == __file__
    assert caplog.records[0].funcName == "test_the_place_is_the_callers"


def test_floods_are_gathered(log: NodeLogger, clock: list[float], caplog: pytest.LogCaptureFixture) -> None:
    """Per line of code; other lines are logged, and all records are counted."""
    for i in range(180):
        clock[0] = 100 + i / 60
        log.warning("wall %d", i)
        if i == 90:
            log.error("DEADLOCK")
    walls = [m for m in caplog.messages if m.startswith("wall")]
    assert walls[:FREE] == [f"wall {i}" for i in range(FREE)]
    assert walls[FREE:] == ["wall 60 (50 more like this in between)", "wall 120 (59 more like this in between)"]
    assert "DEADLOCK" in caplog.messages
    log.log_suppressed()
    assert caplog.messages[-1].startswith("59 more lines from ")
    clock[0] += 5.0
    caplog.clear()
    log.warning("wall again")
    assert caplog.messages == ["wall again"]


def test_news_are_not_gathered(log: NodeLogger, caplog: pytest.LogCaptureFixture) -> None:
    """Records below a warning are not limited."""
    caplog.set_level(logging.INFO, log.name)
    for i in range(100):
        log.info("%d", i)
    assert len(caplog.messages) == 100
