"""Attributes that a node sets and nothing reads, spelt almost as one of its own: `self.is_pased` for `is_paused`."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator, Sequence

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import walk
from graphflow.analysis.words import words_in
from graphflow.errors import Place
from graphflow.names import nearest
from graphflow.runtime.declarations import declared
from graphflow.runtime.mistakes.source.project_words import other_modules


def stray_attributes(cls: type, definition: ast.ClassDef, file: str, mentioned: Collection[str]) -> Iterator[str]:
    """Find attributes that are set, never read, and spelt almost as a declaration or an attribute of the class.

    Args:
        mentioned: The words that the file reads.
    """
    declarations = declared.declarations(cls)
    plain = _attributes(definition) & {*mentioned}
    for method in definition.body:
        own_too = plain - {node.attr for node, _ in _stored(method)}  # what one method sets are two things
        for node, parents in _stored(method):
            if node.attr in mentioned or hasattr(cls, node.attr) or any(isinstance(p, ast.ClassDef) for p in parents):
                continue
            near = nearest(node.attr, declarations, cutoff=0.75) or nearest(node.attr, own_too, cutoff=0.85)
            if near is None or _is_another(node.attr, near):
                continue
            if not any(node.attr in words_in(module) for module in other_modules(file, node.attr)):
                yield f"{Place(file, node.lineno)}: self.{node.attr} is set and never read; did you mean self.{near}?"


def _stored(method: ast.stmt) -> Iterator[tuple[ast.Attribute, Sequence[ast.AST]]]:
    """Yield the attributes of the node that a method sets, with what they are in."""
    for node, parents in walk(method):
        if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) and is_own(node):
            yield node, parents


def _attributes(definition: ast.ClassDef) -> set[str]:
    """Return the plain attributes of a class: those that its body or a method of it sets."""
    of_body = {
        target.id
        for statement in definition.body
        if isinstance(statement, ast.Assign | ast.AnnAssign) and not isinstance(statement.value, ast.Call)
        for target in (statement.targets if isinstance(statement, ast.Assign) else [statement.target])
        if isinstance(target, ast.Name)
    }
    return of_body | {node.attr for method in definition.body for node, _ in _stored(method)}


def _is_another(name: str, near: str) -> bool:
    """Whether a name similar to another one is likely on purpose: `speeds` and `speed`, `goal_y` and `goal_x`."""
    short, long = sorted((name, near), key=len)
    if long in (f"{short}s", f"{short}es", f"_{short}", f"{short}_"):
        return True
    return len(short) == len(long) and short[:-1] == long[:-1] and {short[-1], long[-1]} <= _COUNTING


_COUNTING = {*"0123456789xyzabclr"}
"""Suffixes of numbered names."""
