"""Slices of a message's array that are added: NumPy adds their numbers, and joins nothing."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import nodes_in

_ARRAYS = ("ranges", "intensities")


def added_arrays(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find the lines that add two slices of one array; each comes with the function that joins them."""
    for node in nodes_in(code):
        match node:
            case ast.BinOp(
                left=ast.Subscript(value=ast.Attribute(attr=first), slice=ast.Slice()) as left,
                op=ast.Add(),
                right=ast.Subscript(value=ast.Attribute(attr=second), slice=ast.Slice()) as right,
            ) if first == second and first in _ARRAYS:
                joined = f"numpy.concatenate([{ast.unparse(left)}, {ast.unparse(right)}])"
                yield node.lineno, f"+ adds the numbers of two arrays one by one; to join them write {joined}"
