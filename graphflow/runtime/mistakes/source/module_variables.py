"""Variables of a module by which two node classes exchange values, although their nodes may be in two processes."""

from __future__ import annotations

import ast
import sys
from functools import cache
from typing import NamedTuple

from graphflow.analysis.syntax import nodes_in, syntax_of
from graphflow.errors import Place
from graphflow.runtime.mistakes.source.shadowing import definition_of


class Exchanged(NamedTuple):
    """A variable that a class reads, and that only another class sets."""

    setter: type
    text: str


@cache
def exchanged(cls: type) -> tuple[Exchanged, ...]:
    """Return such variables of a node's class; none of a class whose methods use the other class."""
    try:
        source = definition_of(cls)
        return () if source is None else tuple(_exchanged(cls, *source))
    except (OSError, SyntaxError, ValueError):  # no source to be read
        return ()


def _exchanged(cls: type, definition: ast.ClassDef, file: str) -> list[Exchanged]:
    setters: dict[str, set[ast.AST]] = {}
    """By variable: the statements of the module, classes among them, that set it."""
    for node, parents in syntax_of(file).parts:
        for name in node.names if isinstance(node, ast.Global) else ():
            setters.setdefault(name, set()).add(parents[1])
    found: list[Exchanged] = []
    for name, tops in setters.items():
        match [*tops]:
            case [ast.ClassDef(name=other)] if other != definition.name:
                setter = getattr(sys.modules.get(cls.__module__), other, None)
                uses = [n for n in nodes_in(definition) if isinstance(n, ast.Name) and n.id in (name, other)]
                if not isinstance(setter, type) or {*cls.__mro__} & {*setter.__mro__} == {object}:
                    continue
                if uses and all(use.id == name for use in uses):
                    text = f"{Place(file, uses[0].lineno)}: {other} sets {name}, and runs in another process: send it"
                    found.append(Exchanged(setter, f"{text} on a topic, or give both nodes the same process:"))
    return found
