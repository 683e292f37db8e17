"""Endless loops that catch Ctrl-C."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from graphflow.rclpy.hints.swallowed_interrupts import lines_in
from tests.cases import slow
from tests.conftest import Machine


def work() -> None:
    """Be something that takes a while."""


def swallows() -> None:
    while True:
        try:
            work()
        except:  # noqa: E722
            work()


def swallows_base() -> None:
    while 1:
        try:
            work()
        except BaseException:
            work()


def catches_errors() -> None:
    while True:
        try:
            work()
        except Exception:
            work()


def is_a_prompt() -> None:
    while True:
        try:
            work()
        except KeyboardInterrupt:
            work()


def drains() -> None:
    while True:
        try:
            if input():
                break
        except:  # noqa: E722
            work()


def cleans_up() -> None:
    for _ in range(3):
        try:
            work()
        except:  # noqa: E722
            work()


def raises() -> None:
    while True:
        try:
            work()
        except:
            work()
            raise


def exits() -> None:
    while True:
        try:
            work()
        except:  # noqa: E722
            sys.exit(1)


@pytest.mark.parametrize(
    ("function", "lines"),
    [
        (swallows, [4]),
        (swallows_base, [4]),
        (catches_errors, []),
        (is_a_prompt, []),
        (drains, []),
        (cleans_up, []),
        (raises, []),
        (exits, []),
    ],
)
def test_the_lines(function: Callable[[], None], lines: list[int]) -> None:
    """Only a loop that nothing leaves is named."""
    code = function.__code__
    assert [line - code.co_firstlineno for line in lines_in(code, code.co_firstlineno + 3)] == lines


def test_another_line_of_the_function() -> None:
    """A function that is not in the loop is not stuck there."""
    code = swallows.__code__
    assert list(lines_in(code, code.co_firstlineno)) == []


PROGRAM = """
import rclpy
from rclpy.node import Node

rclpy.init()
node = Node("n")
while True:
    try:
        print("up", flush=True)
        rclpy.spin_once(node)
    except:
        pass
"""


@slow
@pytest.mark.real
def test_a_program_that_catches_ctrl_c(machine: Machine, tmp_path: Path) -> None:
    """It is told why it goes on, and the second Ctrl-C ends it."""
    file = tmp_path / "program.py"
    file.write_text(PROGRAM)
    program = machine.start("run", str(file))
    program.wait_for("up")
    program.process.send_signal(signal.SIGINT)
    program.wait_for("program.py:11 catches KeyboardInterrupt in an endless loop; write except Exception")
    program.process.send_signal(signal.SIGINT)
    assert program.wait() == 1
    assert "ended without cleanup" in program.text
