"""Lines that catch CancelledError."""

from __future__ import annotations

import ast
import asyncio
from contextlib import suppress
from typing import Any

import pytest

from graphflow.analysis.swallowed import caught_in_vain, endless_loops, where_caught

NAME = "test_swallowed.py"


class Waits:
    """Waits in several ways."""

    async def by_name(self) -> None:
        try:
            await asyncio.sleep(1.0)
        except (ValueError, asyncio.CancelledError):  # by its name
            pass
        with suppress(asyncio.CancelledError):  # by suppress
            await asyncio.sleep(1.0)

    async def all_of_them(self) -> None:
        try:
            await asyncio.sleep(1.0)
        except:  # noqa: E722  # everything
            pass

    async def lets_it_pass(self) -> None:
        try:
            await asyncio.sleep(1.0)
        except asyncio.CancelledError:
            raise
        except Exception:
            pass


def line_of(text: str) -> int:
    with open(__file__, encoding="utf-8") as file:
        return next(n for n, line in enumerate(file, 1) if line.rstrip().endswith(f"# {text}"))


def test_lines_that_do_not_let_it_pass() -> None:
    """By its name, or with all others; not those that raise it again, nor of code without a source."""
    waits: Any = Waits()
    first, second, third = (line_of(text) for text in ("by its name", "by suppress", "everything"))
    assert where_caught(waits.by_name) == f"; CancelledError is caught in {NAME}:{first} and {NAME}:{second}"
    assert where_caught(waits.all_of_them) == f"; CancelledError is caught in {NAME}:{third}"
    made: dict[str, Any] = {}
    exec("def made(): ...", made)
    assert [where_caught(fn) for fn in (waits.lets_it_pass, print, made["made"])] == ["", "", ""]


def test_interrupts_that_do_not_come() -> None:
    """Are told in handlers and coroutines; not where the program runs its nodes, nor where they pass."""
    source = """
class Robot(Node):
    @task
    async def drive(self):
        try: ...
        except KeyboardInterrupt:
            self.stop()

    @timer(1.0)
    def tick(self):
        try: ...
        except builtins.KeyboardInterrupt:
            self.stop()
            raise

    @task
    async def passes(self):
        try: ...
        except KeyboardInterrupt:
            raise
        except (KeyboardInterrupt, ValueError):
            self.stop()

    def main(self):
        try:
            graphflow.run(self)
        except KeyboardInterrupt:
            self.stop()

    @staticmethod
    def begin():
        try: ...
        except KeyboardInterrupt:
            print("bye")
"""
    definition = ast.parse(source).body[0]
    assert isinstance(definition, ast.ClassDef)
    text = (
        "KeyboardInterrupt does not come to a node, which Ctrl-C cancels: write finally: in place of except, or do "
        "this in async def on_shutdown(self)"
    )
    assert list(caught_in_vain(definition)) == [(6, text), (12, text)]


LOOP = """
class Node:
    async def work(self):
        {loop}:
            try:
                {body}
            {handler}
"""


def _endless(loop: str, body: str, handler: str) -> list[int]:
    definition = ast.parse(LOOP.format(loop=loop, body=body, handler=handler)).body[0]
    assert isinstance(definition, ast.ClassDef)
    found = list(endless_loops(definition))
    assert all("write except Exception, or raise it again" in text for _, text in found)
    return [line for line, _ in found]


@pytest.mark.parametrize(
    "handler", ["except: self.retry()", "except BaseException: pass", "except (A, CancelledError): 0"]
)
@pytest.mark.parametrize("loop", ["while True", "while self.on", "while True:\n         while True"])
def test_a_loop_that_goes_on_after_a_cancellation(loop: str, handler: str) -> None:
    """The line is told once."""
    assert len(_endless(loop, "await self.call()", handler)) == 1


def test_a_loop_without_a_condition() -> None:
    """Nothing that a handler sets can end it."""
    assert _endless("while True", "await self.call()", "except: self.on = False") == [7]


@pytest.mark.parametrize(
    ("loop", "body", "handler"),
    [
        ("while True", "await self.call()", "except Exception: pass"),
        ("while True", "await self.call()", "except: raise"),
        ("while True", "await self.call()", "except:\n                if self.done: return"),
        ("while True", "await self.call()", "except CancelledError: break"),
        ("while self.on", "await self.call()", "except CancelledError: self.on = False"),
        ("while True", "self.call()", "except: pass"),
        ("if True", "await self.call()", "except: pass"),
    ],
)
def test_loops_that_end(loop: str, body: str, handler: str) -> None:
    """They let the cancellation through, or end by themselves, or await nothing there."""
    assert _endless(loop, body, handler) == []
