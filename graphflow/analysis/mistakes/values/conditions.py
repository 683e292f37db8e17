"""Conditions that always have the same value: `if self.near_wall:` of a method, `== "A" or "B"`, a misspelt state.

`never_equal` has those that depend on the declarations of a node.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from functools import cache

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.bindings import bindings_of
from graphflow.analysis.syntax import FunctionNode, nodes_in, walk
from graphflow.names import nearest


@cache
def constant_conditions(module: ast.Module) -> tuple[tuple[int, str], ...]:
    """Return the lines of a file with such a condition; each comes with its correction."""
    return (*_always(module), *_misspelt_states(module))


def _always(module: ast.Module) -> Iterator[tuple[int, str]]:
    methods = _Methods(module)
    for node, parents in walk(module):
        if isinstance(node, (ast.If, ast.While, ast.IfExp)):
            for tested in _tested(node.test):
                text = _or_text(tested) if isinstance(tested, ast.BoolOp) else methods.uncalled(tested, parents)
                if text:
                    yield tested.lineno, text


def _tested(condition: ast.expr) -> Iterator[ast.expr]:
    """Yield a condition, and those that it consists of."""
    yield condition
    match condition:
        case ast.BoolOp(values=parts):
            for part in parts:
                yield from _tested(part)
        case ast.UnaryOp(op=ast.Not(), operand=part):
            yield from _tested(part)


class _Methods:
    """The plain methods of a file's classes, which have no decorator and are never replaced."""

    def __init__(self, module: ast.Module) -> None:
        self._set: set[str] = set()
        for node in nodes_in(module):
            match node:
                case ast.Attribute(attr=name, ctx=ast.Store() | ast.Del()) | ast.Name(id=name, ctx=ast.Store()):
                    self._set.add(name)
                case ast.Call(func=ast.Name(id="setattr"), args=[_, ast.Constant(value=str(name)), *_]):
                    self._set.add(name)

    def uncalled(self, tested: ast.expr, parents: Sequence[ast.AST]) -> str:
        """Return a sentence for a condition that is a method itself; empty for any other."""
        if not is_own(tested) or tested.attr in self._set:
            return ""
        owner = next((p for p in reversed(parents) if isinstance(p, ast.ClassDef)), None)
        found = [m for m in owner.body if isinstance(m, FunctionNode) and m.name == tested.attr] if owner else []
        if len(found) != 1 or found[0].decorator_list or _is_hook(found[0]):
            return ""
        method, name = found[0], ast.unparse(tested)
        takes = "..." if len(method.args.args) > 1 else ""
        wait = "await " if isinstance(method, ast.AsyncFunctionDef) else ""
        return f"{name} is a method, and so always true; write {wait}{name}({takes})"


def _is_hook(method: FunctionNode) -> bool:
    """Whether a method does nothing, and may be there for subclasses to replace, by None as well."""
    return all(
        isinstance(s, (ast.Pass, ast.Raise)) or (isinstance(s, ast.Expr) and isinstance(s.value, ast.Constant))
        for s in method.body
    )


def _or_text(condition: ast.BoolOp) -> str:
    """Return a sentence for `x == "A" or "B"`; empty for any other condition."""
    match condition.values:
        case [ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq() as op], comparators=[ast.Constant() as first]), *rest]:
            constants = [value for value in rest if isinstance(value, ast.Constant)]
            if len(constants) < len(rest) or not all(_is_alike(first.value, other.value) for other in constants):
                return ""
            choices = ", ".join(ast.unparse(constant) for constant in (first, *constants))
            word = "in" if isinstance(op, ast.Eq) else "not in"
            shown = ast.unparse(constants[0])
            text = f"{ast.unparse(condition)} does not compare {ast.unparse(left)} with {shown}, which is always true"
            return f"{text}; write {ast.unparse(left)} {word} ({choices})"
    return ""


def _is_alike(first: object, other: object) -> bool:
    """Whether two constants are both texts, or both numbers, and the second is true."""
    is_text = isinstance(first, str) and isinstance(other, str)
    return bool(other) and (is_text or all(type(value) in (int, float) for value in (first, other)))


def _misspelt_states(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find comparisons of an attribute with a text like one it is set to, which no line compares it with.

    The attribute must be set to texts alone, wherever the file sets one of that name.
    """
    compared = [*_compared_texts(module)]
    bindings = bindings_of(module)
    set_: dict[str, set[str] | None] = {}
    texts = {text for _, _, text, _ in compared}
    for attribute, line, text, parents in compared:
        if attribute.attr not in set_:
            values = [value.expression for value in bindings.of(attribute, parents)]
            set_[attribute.attr] = _texts_set(module, attribute.attr) if values else None
        given = set_[attribute.attr]
        if given is None or text in given:
            continue
        near = nearest(text, sorted(given - texts))
        if near is not None:
            shown = ast.unparse(attribute)
            yield line, f"{shown} is set to {near!r}, and never to {text!r}; did you mean {near!r}?"


def _compared_texts(module: ast.Module) -> Iterator[tuple[ast.Attribute, int, str, list[ast.AST]]]:
    """Yield the attributes of `self` that are compared with a text, each with its line, the text and its parents."""
    for node, parents in walk(module):
        match node:
            case ast.Compare(left=left, comparators=[right]):
                for subject, other in ((left, right), (right, left)):
                    if is_own(subject):
                        yield from ((subject, c.lineno, t, parents) for c, t in _texts(other))
            case ast.Match(subject=subject, cases=cases) if is_own(subject):
                found = [part for case in cases for part in _texts(case.pattern)]
                yield from ((subject, c.lineno, t, parents) for c, t in found)


def _texts(part: ast.AST) -> Iterator[tuple[ast.Constant, str]]:
    for node in nodes_in(part):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node, node.value


def _texts_set(module: ast.Module, name: str) -> set[str] | None:
    """Return the texts that attributes of a name are set to; None if they may have other values."""
    found: set[str] = set()
    places = 0
    for node in nodes_in(module):
        match node:
            case (
                ast.Assign(targets=[target], value=ast.expr() as value)
                | ast.AnnAssign(target=target, value=ast.expr() as value)
            ) if _names(target, name):
                places -= isinstance(target, ast.Attribute)
                values = _constants(value)
                if values is None:
                    return None
                found |= values
            case ast.Attribute(attr=attr, ctx=ast.Store() | ast.Del()) if attr == name:
                places += 1
            case ast.Call(func=ast.Name(id="setattr")):
                return None
            case ast.FunctionDef(name=other) | ast.AsyncFunctionDef(name=other) if other == name:
                return None
    return found if not places else None  # other statements set it, too


def _names(target: ast.expr, name: str) -> bool:
    """Whether a target is an attribute of a name, or a name itself, as in the body of a class."""
    return (isinstance(target, ast.Attribute) and target.attr == name) or (
        isinstance(target, ast.Name) and target.id == name
    )


def _constants(value: ast.expr) -> set[str] | None:
    """Return the texts that an expression may be; None if it may be something else."""
    match value:
        case ast.Constant(value=str(text)):
            return {text}
        case ast.Constant(value=None):
            return set()
        case ast.IfExp(body=first, orelse=second):
            found = [_constants(first), _constants(second)]
            return set().union(*(f for f in found if f is not None)) if None not in found else None
    return None
