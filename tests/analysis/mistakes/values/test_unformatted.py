"""Texts that lack their f."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.unformatted import unformatted

METHOD = "class A:\n  def heard(self, msg):\n    count = 1\n    {}\n"


@pytest.mark.parametrize(
    ("line", "field"),
    [
        ('self.log.info("at {self.pose.x:.1f}, {self.pose.y}")', "{self.pose.x:.1f}"),
        ("self.get_logger().warning('heard {msg.data!r}')", "{msg.data!r}"),
        ("print('{count} messages')", "{count}"),
        ("print('{self.names[0]} and {self.now()}')", "{self.names[0]}"),
        ("self.pub.publish(String(data='Hello {count}'))", "{count}"),
        ("message.data = 'Hello {count}'", "{count}"),
    ],
)
def test_texts_without_an_f(line: str, field: str) -> None:
    """The first field is named."""
    told = f"{field} stays as it is written: put an f in front of the text, f'...'"
    assert list(unformatted(ast.parse(METHOD.replace("{}", line)))) == [(4, told)]


@pytest.mark.parametrize(
    "line",
    [
        "print(f'{count} messages')",
        "print('{count} messages'.format(count=count))",
        "print('{other} messages')",
        "print('{\"count\": 1}')",
        "print('{} messages', count)",
        "text = '{count} messages'",
        "message.name = '{count}'",
        "print('{1: count}')",
    ],
)
def test_texts_that_are_meant_so(line: str) -> None:
    """Those with an f or a format, with other names, and those that are kept are left alone."""
    assert list(unformatted(ast.parse(METHOD.replace("{}", line)))) == []


def test_a_text_outside_of_functions() -> None:
    """It has no variables of its own."""
    assert list(unformatted(ast.parse("count = 1\nprint('{count}')"))) == []
