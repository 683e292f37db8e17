"""Transforms that are sent once, at a start, by what is for those that change: nobody finds them a moment later."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import REPEATING, FunctionNode, last_name, nodes_in, walk

_SENDERS = {"Transforms": "send", "TransformBroadcaster": "sendTransform"}
"""Classes that send transforms, and their methods that do."""
_STATIC = {"send": "write {}.send_static", "sendTransform": "take a StaticTransformBroadcaster"}
_STARTS = ("__init__", "on_start")


def single_transforms(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find the lines that send a transform of a class whose nodes send none later; each comes with its correction."""
    for definition in nodes_in(code):
        if isinstance(definition, ast.ClassDef):
            for name, method in _senders(definition).items():
                yield from _single(definition, name, method)


def _senders(definition: ast.ClassDef) -> dict[str, str]:
    """Return the attributes that send transforms, each with the method that does."""
    found: dict[str, str] = {}
    for node in nodes_in(definition):
        match node:
            case ast.Assign(
                targets=[ast.Name(id=name) | ast.Attribute(value=ast.Name(id="self"), attr=name)],
                value=ast.Call(func=function),
            ) if (method := _SENDERS.get(last_name(function))) is not None:
                found[name] = method
    return found


def _single(definition: ast.ClassDef, name: str, method: str) -> Iterator[tuple[int, str]]:
    uses = [(use, parents) for use, parents in walk(definition) if isinstance(use, ast.Attribute) and use.attr == name]
    uses = [(use, parents) for use, parents in uses if isinstance(use.ctx, ast.Load)]
    if not all(is_own(use) and isinstance(parents[-1], ast.Attribute) for use, parents in uses):
        return  # it is passed on, and may be used anywhere
    sends = [(use, parents) for use, parents in uses if getattr(parents[-1], "attr", "") == method]
    methods = {*_STARTS, *_called_at_start(definition)}
    often = {_child(parents) for _, parents in sends if not _runs_once(parents, methods)}
    for use, parents in sends:
        # Beside others that are sent often, it is of another frame, if both frames are known.
        is_other = not often or ("" not in often and _child(parents) not in ("", *often))
        if is_other and _runs_once(parents, methods):
            text = f"{ast.unparse(use)}.{method} runs once, and its transform holds for that moment alone"
            static = _STATIC[method].format(ast.unparse(use))
            yield use.lineno, f"{text}; for one that never changes, {static}; send others again, as in a timer"


def _child(parents: Sequence[ast.AST]) -> str:
    """Return the child frame of the transform that a call sends, `Transform.of(parent, child, ...)`; "" if unknown."""
    match parents[-2:]:
        case [ast.Call(args=[ast.Call(args=[_, ast.Constant(value=str(child)), *_])]), ast.Attribute()]:
            return child
    return ""


def _called_at_start(definition: ast.ClassDef) -> Iterator[str]:
    """Yield the methods that are only called, and only where a node starts."""
    uses: dict[str, list[Sequence[ast.AST]]] = {}
    for node, parents in walk(definition):
        if isinstance(node, ast.Attribute) and is_own(node):
            uses.setdefault(node.attr, []).append([*parents, node])
    for method in definition.body:
        if isinstance(method, FunctionNode) and (found := uses.get(method.name)) and not method.decorator_list:
            calls = [isinstance(path[-2], ast.Call) and path[-2].func is path[-1] for path in found]
            if all(calls) and all(_runs_once(path, set(_STARTS)) for path in found):
                yield method.name


def _runs_once(parents: Sequence[ast.AST], methods: set[str]) -> bool:
    """Whether something in a class runs once, when one of its methods does: outside loops and inner functions."""
    _, method, *inner = parents
    return (
        isinstance(method, FunctionNode)
        and method.name in methods
        and not any(isinstance(node, REPEATING) for node in inner)
    )
