"""Callbacks that do not do what they were written for."""

from __future__ import annotations

import ast
import textwrap

import pytest

from graphflow.analysis.mistakes.calls.misgiven import misgiven

METHODS = """\
class Lamp(Node):
    def heard(self, message): ...
    def tick(self): ...
    async def work(self): ...
    @property
    def answer(self): ...
    def made(self):
"""
FIRST = METHODS.count("\n") + 1
BACK = "the lambda returns the method {0} instead of calling it; write {1}"
LAST = "each lambda on this line sees the last {0} of the loop; write lambda {1}: ..."


def told(body: str) -> list[str]:
    return [text for _, text in misgiven(ast.parse(METHODS + textwrap.indent(body, "        ")))]


@pytest.mark.parametrize(
    ("body", "text"),
    [
        ("self.create_timer(1.0, lambda: self.tick)", BACK.format("self.tick", "self.tick in place of the lambda")),
        (
            "self.create_subscription(Pose, 'pose', callback=lambda m: self.heard, qos_profile=10)",
            BACK.format("self.heard", "self.heard in place of the lambda"),
        ),
        ("f.add_done_callback(lambda f: self.tick)", BACK.format("self.tick", "lambda f: self.tick(...)")),
        ("self.create_timer(1.0, lambda: self.tick())", ""),
        ("self.create_service(Trigger, 'a', lambda q, r: self.answer)", ""),
        ("self.create_service(Trigger, 'a', lambda q, r: r)", ""),
        ("self.tick = other\nself.create_timer(1.0, lambda: self.tick)", ""),
        ("self.get = lambda: self.tick", ""),
        ("sorted(a, key=lambda x: self.tick)", ""),
    ],
)
def test_lambdas_that_call_nothing(body: str, text: str) -> None:
    """They are reported when passed as callbacks; a service's callback may return the response."""
    assert told(body) == ([text] if text else [])


@pytest.mark.parametrize(
    ("body", "text"),
    [
        ("for i in range(3):\n    self.create_timer(1.0, lambda: self.show(i))", LAST.format("i", "i=i")),
        (
            "for i, name in enumerate(names):\n    self.create_subscription(P, name, lambda m: self.at(name, m), 10)",
            LAST.format("name", "m, name=name"),
        ),
        (
            "for i in range(3):\n    name = f't{i}'\n    self.create_timer(1.0, lambda *a: print(name))",
            LAST.format("name", "*a, name=name"),
        ),
        ("self.ts = [self.create_timer(1.0, lambda: self.show(i)) for i in range(3)]", LAST.format("i", "i=i")),
        (
            "for i in range(3):\n    def cb(m):\n        self.at(i, m)\n    self.create_subscription(P, 'p', cb, 10)",
            "each cb in this loop sees the last i; write def cb(m, i=i):",
        ),
        (
            "for i in range(3):\n    rclpy.spin_until_future_complete(self, f)\n"
            "    self.create_timer(1.0, lambda: self.show(i))",
            LAST.format("i", "i=i"),
        ),
        (
            "for i in range(3):\n    t = self.create_timer(1.0, lambda: self.show(i))\n    rclpy.spin_once(self)\n"
            "    t.cancel()",
            "",
        ),
        ("for i in range(3):\n    self.create_timer(1.0, lambda i=i: self.show(i))", ""),
        ("for i in range(3):\n    self.create_timer(1.0, partial(self.show, i))", ""),
        ("for i in range(3):\n    self.create_timer(1.0, self.shows(i))", ""),
        ("for i in range(3):\n    self.create_timer(1.0, lambda: self.tick())", ""),
        ("for i in range(3):\n    self.create_timer(1.0, lambda: [i for i in self.all])", ""),
        ("def make(i):\n    self.create_timer(1.0, lambda: self.show(i))\nfor i in range(3):\n    make(i)", ""),
        ("for i in [3]:\n    self.create_timer(1.0, lambda: self.show(i))", ""),
        ("for i in a:\n    if i.ok:\n        self.create_timer(1.0, lambda: self.show(i))\n        break", ""),
        (
            "for i in a:\n    f = c.call_async(i)\n    f.add_done_callback(lambda f: self.got(i, f))\n"
            "    rclpy.spin_until_future_complete(self, f)",
            "",
        ),
        ("n = 0\nfor i in a:\n    n += 1\n    self.create_timer(1.0, lambda: self.show(n))", ""),
        ("for i in a:\n    self.create_timer(1.0, lambda: self.show(b))", ""),
    ],
)
def test_callbacks_of_a_loop(body: str, text: str) -> None:
    """They are reported with a correction, except if they cannot outlive their iteration."""
    assert told(body) == ([text] if text else [])


def test_the_line() -> None:
    """That of the function, the first one first."""
    body = "self.create_timer(1.0,\n    lambda: self.tick)\nself.create_timer(1.0, lambda: self.tick)\n"
    found = misgiven(ast.parse(METHODS + textwrap.indent(body, "        ")))
    assert [line for line, _ in found] == [FIRST + 1, FIRST + 2]


@pytest.mark.parametrize(
    ("body", "way"),
    [
        ("await asyncio.to_thread(self.work, 3)", "await self.work(...)"),
        ("await loop.run_in_executor(None, self.work)", "await self.work(...)"),
        ("Thread(target=self.work, daemon=True).start()", "self.spawn(self.work)"),
        ("threading.Timer(1.0, self.work).start()", "self.spawn(self.work)"),
        ("pool.submit(self.work)", "self.spawn(self.work)"),
        ("Thread(target=self.tick).start()", ""),
        ("await asyncio.to_thread(self.tick)", ""),
        ("Timer(1.0, self.tick, [self.work])", ""),
        ("self.work = print\nThread(target=self.work).start()", ""),
    ],
)
def test_coroutines_in_threads(body: str, way: str) -> None:
    """They are reported with the function that runs them."""
    text = f"work is an `async def`, which a thread cannot run; write {way}"
    assert told(body) == ([text] if way else [])
