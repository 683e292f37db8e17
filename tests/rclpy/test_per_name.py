"""What is made once."""

from __future__ import annotations

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from graphflow.rclpy.messages.classes import message_class
from graphflow.rclpy.per_name import made_once


def test_threads_that_ask_at_the_same_time_get_the_same() -> None:
    """However long it takes to make, and though making it asks for another."""
    meet = threading.Barrier(4)

    @made_once
    def make(name: str) -> object:
        if name == "outer":
            make("inner")
        time.sleep(0.02)
        return object()

    def ask(name: str) -> object:
        meet.wait(10)
        return make(name)

    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(ask, ["outer", "outer", "inner", "inner"]))
    assert found[0] is found[1] is make("outer")
    assert found[2] is found[3] is make("inner")


def test_what_fails_is_tried_again() -> None:
    """An error is not kept."""
    fails = [ValueError(), None]

    @made_once
    def make(name: str) -> str:
        error = fails.pop(0)
        if error is not None:
            raise error
        return name

    with pytest.raises(ValueError):
        make("a")
    assert make("a") == "a"


def test_message_classes_are() -> None:
    """Two nodes that are made in two threads need the same ones."""
    name, meet = "diagnostic_msgs/msg/DiagnosticArray", threading.Barrier(8)

    def ask(_: int) -> type:
        meet.wait(10)
        return message_class(name)

    with ThreadPoolExecutor(8) as threads:
        assert len(set(threads.map(ask, range(8)))) == 1
