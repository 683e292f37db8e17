"""A parser that fails as Python 3.11's does where two threads use it at once."""

from __future__ import annotations

import ast

import pytest


def disturb(monkeypatch: pytest.MonkeyPatch, failures: int) -> None:
    """Have `ast.parse` fail that often, and then parse."""
    parse, left = ast.parse, [SystemError("AST constructor recursion depth mismatch")] * failures

    def disturbed(text: str) -> ast.Module:
        if left:
            raise left.pop()
        return parse(text)

    monkeypatch.setattr(ast, "parse", disturbed)
