"""Signals."""

from __future__ import annotations

import _thread
import logging
import os
import signal
import sys
import threading
import time

import pytest

import rclpy
from rclpy import signals
from rclpy.signals import SignalHandlerOptions


def test_sigint_ends_the_context_and_then_does_what_it_did() -> None:
    """It raises KeyboardInterrupt; what asked for the end is told."""
    rclpy.init()
    told = threading.Event()
    rclpy.get_default_context().on_shutdown(told.set)
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)
        threading.Event().wait(5)
    assert not rclpy.ok()
    assert told.wait(5)
    with pytest.raises(RuntimeError, match="already called"):
        rclpy.shutdown()


def test_logging_is_not_torn_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    """An exception in the middle of it would keep a lock that other threads wait for: it comes a little later."""
    rclpy.init()
    inside: list[bool] = []
    began = time.monotonic()

    class Interrupted(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            os.kill(os.getpid(), signal.SIGINT)
            inside.append(rclpy.ok())

    logger = logging.getLogger("interrupted")
    logger.addHandler(Interrupted())
    with pytest.raises(KeyboardInterrupt):
        logger.error("x")
        inside.append(True)
        threading.Event().wait(60)
    assert inside == [True, True]
    assert time.monotonic() - began < 30
    monkeypatch.setattr(signals, "PUT_OFF_BOUND", 0)
    with pytest.raises(KeyboardInterrupt):
        logger.error("x")
    rclpy.try_shutdown()


def test_while_the_interpreter_ends_another_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """It would end in the middle of leaving the network."""
    rclpy.init()
    monkeypatch.setattr(threading.main_thread(), "is_alive", lambda: False)
    os.kill(os.getpid(), signal.SIGINT)
    assert not rclpy.ok()
    rclpy.try_shutdown()


def test_handlers_are_put_back() -> None:
    """At the end; and only those that were asked for are handled."""
    former = signal.getsignal(signal.SIGTERM)
    rclpy.init()
    assert signals.get_current_signal_handlers_options() is SignalHandlerOptions.ALL
    assert signal.getsignal(signal.SIGTERM) is not former
    rclpy.shutdown()
    assert signal.getsignal(signal.SIGTERM) is former
    rclpy.init(signal_handler_options=SignalHandlerOptions.SIGINT)
    assert signal.getsignal(signal.SIGTERM) is former
    rclpy.shutdown()
    assert signals.get_current_signal_handlers_options() is SignalHandlerOptions.NO


def test_outside_the_main_thread_nothing_is_handled() -> None:
    """Python cannot."""
    thread = threading.Thread(target=rclpy.init)
    thread.start()
    thread.join()
    assert rclpy.ok()
    assert signals.get_current_signal_handlers_options() is SignalHandlerOptions.NO


def test_a_signal_is_not_put_off_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    """Logging itself may be what never ends."""
    started: list[object] = []
    monkeypatch.setattr(signals, "PUT_OFF_BOUND", 3)
    monkeypatch.setattr(signals, "_put_off", {})
    monkeypatch.setattr(signals, "_is_in_logging", lambda _: True)
    monkeypatch.setattr(signals, "_former", {})
    monkeypatch.setattr(_thread, "start_new_thread", lambda fn, _: started.append(fn))
    for _ in range(4):
        signals._caught(signal.SIGINT, sys._getframe())
    assert started == [signals._again] * 3
    assert signals._put_off == {}
