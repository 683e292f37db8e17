"""Definitions and assignments without effect."""

from __future__ import annotations

import ast
from textwrap import dedent

import pytest

from graphflow.analysis.mistakes.calls.misplaced import misplaced, replaced_methods


def told(body: str) -> list[tuple[int, str]]:
    definition = ast.parse(
        "class Robot(Node):\n" + "".join(f"    {line}\n" for line in dedent(body).splitlines())
    ).body[0]
    assert isinstance(definition, ast.ClassDef)
    return list(misplaced(definition))


@pytest.mark.parametrize(
    ("body", "text"),
    [
        ("def _init_(self): ...", "_init_ is never called: write __init__, with two underscores on each side"),
        ("def __inti__(self): ...", "__inti__ is never called: write __init__"),
        (
            "def __init__(self):\n    @timer(0.5)\n    def tick(self): ...",
            "@timer has no effect inside __init__: move tick into the class body",
        ),
        (
            "def f(self):\n    self.pub.publish = message",
            "self.pub.publish is a method: write self.pub.publish(message)",
        ),
        (
            "def f(self):\n    msg = String()\n    self.pub.publish = msg",
            "self.pub.publish is a method: write self.pub.publish(msg)",
        ),
        (
            "def f(self):\n    self.get_logger().info = 'ready'",
            "self.get_logger().info is a method: write self.get_logger().info('ready')",
        ),
        ("def f(self):\n    self.log.warning = text()", "self.log.warning is a method: write self.log.warning(text())"),
        (
            "async def run(self, goal):\n    goal.feedback = F(x=1)",
            "goal.feedback is a method: write goal.feedback(F(x=1))",
        ),
        ("def f(self, gh):\n    gh.publish_feedback = M.F(a=1)", "gh.publish_feedback is a method: write gh.publish_f"),
    ],
)
def test_without_effect(body: str, text: str) -> None:
    """Each is told with what to write."""
    if "= message" in body:
        body = body.replace("= message", "= String(data='x')")
        text = text.replace("(message)", "(String(data='x'))")
    [(_, found)] = told(body)
    assert found.startswith(text)


@pytest.mark.parametrize(
    "body",
    [
        *("def __init__(self): ...", "def __int__(self): return 1", "def initialize(self): ..."),
        "def f(self):\n    self.publish = 1",
        "def f(self):\n    self.other.publish = lambda m: None",
        "def f(self):\n    self.other.publish = Mock()",
        "def f(self, fake):\n    self.other.publish = fake",
        "def f(self):\n    self.map.info = info()",
        "def f(self):\n    @cache\n    def g(): ...",
        "def f(self, form):\n    form.feedback = 'good'",
    ],
)
def test_what_may_be_meant(body: str) -> None:
    """Other names, functions in the place of methods, and other decorators."""
    assert told(body) == []


def test_of_a_whole_file() -> None:
    """Assignments to methods are found in programs without a class, too."""
    [(line, _)] = replaced_methods(ast.parse("x = 1\npub.publish = String(data='a')"))
    assert line == 2
