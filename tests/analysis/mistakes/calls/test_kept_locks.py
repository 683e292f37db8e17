"""Locks that a return keeps."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.kept_locks import kept_locks

METHOD = """
async def heard(self, n):
    {acquire}
    {between}
    self.lock.release()
    {after}
"""


def _told(acquire: str, between: str, after: str = "pass") -> list[tuple[int, str]]:
    return list(kept_locks(ast.parse(METHOD.format(acquire=acquire, between=between, after=after))))


@pytest.mark.parametrize("between", ["if n == 1: return", "return", "for i in n: return 1"])
def test_a_return_that_keeps_a_lock(between: str) -> None:
    """The line of the return is told, with the form that releases it."""
    way = "with self.lock: in place of acquire() and release()"
    assert _told("await self.lock.acquire()", between) == [(4, f"this return keeps self.lock: write async {way}")]
    assert _told("self.lock.acquire()", between) == [(4, f"this return keeps self.lock: write {way}")]


@pytest.mark.parametrize(
    ("acquire", "between", "after"),
    [
        ("await self.other.acquire()", "return", "pass"),
        ("await self.lock.acquire()", "self.run()", "return"),
        ("await self.lock.acquire()", "if n: self.lock.release(); return", "pass"),
        ("await self.lock.acquire()", "try: return\n    finally: self.lock.release()", "pass"),
        ("await self.lock.acquire()", "def later(): return 1", "pass"),
        ("await self.lock.acquire()", "self.call(lambda: 1)", "pass"),
        ("pass", "return", "pass"),
    ],
)
def test_returns_that_keep_none(acquire: str, between: str, after: str) -> None:
    """The lock is released before, or the return is that of another function."""
    assert _told(acquire, between, after) == []
