"""Work in the background that is taken for something else."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.background_work import background_work


@pytest.mark.parametrize("call", ["asyncio.gather", "gather"])
def test_a_gather_that_nothing_awaits(call: str) -> None:
    """It is told with its line and the correction."""
    code = f"class A:\n  async def lift(self):\n    {call}(self.left(), self.right())\n    self.log.info('up')\n"
    text = f"{call}(...) is not awaited, so that the next line does not wait for it; write await {call}(...)"
    assert list(background_work(ast.parse(code))) == [(3, text)]


@pytest.mark.parametrize(
    ("line", "way"),
    [
        ("self.wailing = self.spawn(self.wail)", "write self.wailing = asyncio.create_task(self.wail())"),
        ("task = self.spawn(self.go, 1, goal)", "write task = asyncio.create_task(self.go(1, goal))"),
        ("await self.spawn(self.wail)", "write await self.wail()"),
        ("self.wailing = self.spawn()", "write self.wailing = asyncio.create_task(self.work())"),
    ],
)
def test_the_result_of_spawn(line: str, way: str) -> None:
    """There is none; what to write depends on its use."""
    code = f"class A:\n  async def heard(self, alarm):\n    {line}\n"
    assert list(background_work(ast.parse(code))) == [(3, f"self.spawn returns nothing; {way}")]


@pytest.mark.parametrize(
    "code",
    [
        "async def f():\n    await gather(a(), b())",
        "async def f():\n    self.moves = asyncio.gather(a(), b())",
        "async def f():\n    return gather(a())",
        "def f():\n    gather(a())",
        "async def f():\n    def g():\n        gather(a())\n    g()",
        "async def f():\n    self.gather_parts()",
        "def f():\n    self.spawn(self.wail)",
        "def f():\n    self.process = pool.spawn(1)",
    ],
)
def test_what_is_kept_or_only_started(code: str) -> None:
    """Gathers that are awaited or kept, those of plain functions, and work that is spawned are left alone."""
    assert list(background_work(ast.parse(code))) == []
