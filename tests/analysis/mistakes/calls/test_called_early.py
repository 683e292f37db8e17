"""Functions that are called where they should be passed."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.called_early import results_passed, spins_called

SOURCE = """
import rclpy
from functools import partial
from elsewhere import made

def work(speed):
    print(speed)

def maker():
    return print

def runs():
    yield 1

def spare():
    raise NotImplementedError

def twice():
    print(1)

class Lamp(Node):
    def __init__(self, given):
        self.set = made
        {line}

    def tick(self):
        self.on = True

    def set(self):
        self.on = True

    def make(self):
        def inner():
            return 1
        return inner

    def later(self):
        pass

    async def soon(self):
        self.on = True

class Other:
    def twice(self):
        print(2)
    twice = made
"""
LINE = 24


def told(line: str, *, is_of_threads: bool) -> list[tuple[int, str]]:
    return list(results_passed(ast.parse(SOURCE.format(line=line)), is_of_threads=is_of_threads))


EVER = "at once, and it does not return before the program ends; write"
HERE = "at once, and passes on its result, None; write"


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("Thread(target=self.tick(), daemon=True).start()", f"target=self.tick() calls tick {HERE} target=self.tick"),
        ("Thread(None, work(1.0))", f"target=work(1.0) calls work {HERE} target=work, args=(1.0,)"),
        ("Process(target=work(1, 2))", f"target=work(1, 2) calls work {HERE} target=work, args=(1, 2)"),
        ("Timer(2.0, work(speed=1))", f"Timer(..., work(speed=1)) calls work {HERE} work, kwargs={{'speed': 1}}"),
        ("pool.submit(work(1, speed=2))", f"submit(..., work(1, speed=2)) calls work {HERE} work, 1, speed=2"),
    ],
)
def test_functions_of_threads(line: str, text: str) -> None:
    """The thread gets the function, and its arguments apart."""
    assert told(line, is_of_threads=True) == [(LINE, text)]
    assert told(line, is_of_threads=False) == []


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("self.create_timer(1.0, self.tick())", f"create_timer(..., self.tick()) calls tick {HERE} self.tick"),
        ("f.add_done_callback(work(3))",
         f"add_done_callback(..., work(3)) calls work {HERE} lambda future: work(3, future)"),
        ("ActionServer(self, A, 'a', execute_callback=work(3))",
         f"execute_callback=work(3) calls work {HERE} execute_callback=lambda goal_handle: work(3, goal_handle)"),
    ],
)  # fmt: skip
def test_callbacks(line: str, text: str) -> None:
    """The node gets the function."""
    assert told(line, is_of_threads=False) == [(LINE, text)]
    assert told(line, is_of_threads=True) == []


@pytest.mark.parametrize(
    "line",
    [
        "Thread(target=self.tick)",
        "Thread(target=partial(work, 1))",
        "Thread(target=self.make())",
        "Thread(target=maker())",
        "Thread(target=made())",
        "Thread(target=given())",
        "Thread(target=runs())",
        "Thread(target=spare())",
        "Thread(target=self.set())",
        "Thread(target=self.later())",
        "Thread(target=self.unknown())",
        "Thread(target=self.twice())",
        "Thread(target=other.tick())",
        "loop.create_task(self.soon())",
        "print(work(1))",
        "Thread(target=work, args=(work(1),))",
    ],
)
def test_calls_that_return_a_function(line: str) -> None:
    """Or may: nothing is told of them, nor of functions that are passed."""
    assert told(line, is_of_threads=True) == told(line, is_of_threads=False) == []


@pytest.mark.parametrize(
    ("line", "text"),
    [
        (
            "Thread(target=rclpy.spin(n), daemon=True)",
            f"target=rclpy.spin(n) calls rclpy.spin {EVER} target=rclpy.spin, args=(n,)",
        ),
        (
            "Thread(target=self.executor.spin())",
            f"target=self.executor.spin() calls self.executor.spin {EVER} target=self.executor.spin",
        ),
        ("pool.submit(rclpy.spin(n))", f"submit(..., rclpy.spin(n)) calls rclpy.spin {EVER} rclpy.spin, n"),
    ],
)
def test_spins(line: str, text: str) -> None:
    """They do not return."""
    [early] = spins_called(ast.parse(SOURCE.format(line=line)))
    assert (early.line, early.text) == (LINE, text)


@pytest.mark.parametrize(
    "line", ["Thread(target=rclpy.spin, args=(n,))", "rclpy.spin(n)", "Thread(target=wheel.spin())"]
)
def test_spins_that_threads_call(line: str) -> None:
    """Nothing is told of those, nor of what only has the name."""
    assert list(spins_called(ast.parse(SOURCE.format(line=line)))) == []
