"""Groups made where handlers name them."""

from __future__ import annotations

import ast

from graphflow.analysis.mistakes.calls.separate_groups import separate_groups

SOURCE = """
class Arm(Node):
    arm = Group(1)

    @timer(1.0, group={0})
    async def move(self): pass

    @service(Trigger, "grip", group={1})
    async def grip(self, request): pass
"""


def told(first: str, second: str) -> list[tuple[int, str]]:
    [definition] = ast.parse(SOURCE.format(first, second)).body
    assert isinstance(definition, ast.ClassDef)
    return list(separate_groups(definition))


def test_two_groups() -> None:
    """The sentence has the shared one."""
    [(line, text)] = told("Group(1)", "graphflow.Group(1)")
    assert line == 8
    assert "another group than that in line 5" in text
    assert text.endswith("write shared = graphflow.Group(1) in the class, and group=shared in both")


def test_one_group() -> None:
    """Handlers that share one, and a single handler with its own, are left alone."""
    assert told("arm", "arm") == told("arm", "Group(1)") == []
