"""Syntax trees of source files, each parsed and walked once however many classes it has, and the shared walker."""

from __future__ import annotations

import ast
import tokenize
from collections.abc import Iterator, Sequence
from functools import cache, cached_property

from graphflow.reading import parsed

FunctionNode = ast.FunctionDef | ast.AsyncFunctionDef
NESTED = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
LOOPS = (ast.For, ast.AsyncFor, ast.While, ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
REPEATING = (*LOOPS, *NESTED, ast.ClassDef)
"""Syntax that may run the code inside it more than once, or later."""


_CHILDREN = "_graphflow_children"
"""Attribute of a node with the nodes directly below it: dozens of checks ask for those of the same tree."""


def children_of(node: ast.AST) -> tuple[ast.AST, ...]:
    """Return the nodes directly below a node, in source order."""
    known: tuple[ast.AST, ...] | None = node.__dict__.get(_CHILDREN)
    if known is None:
        known = node.__dict__[_CHILDREN] = (*ast.iter_child_nodes(node),)
    return known


def nodes_in(top: ast.AST) -> list[ast.AST]:
    """Return a node and all nodes below it, breadth first."""
    found = [top]
    for node in found:  # it grows meanwhile
        found += children_of(node)
    return found


def walk(top: ast.AST, *, into_functions: bool = True) -> Iterator[tuple[ast.AST, list[ast.AST]]]:
    """Yield a node and all nodes below it in source order, each with the nodes that enclose it, the outermost first.

    Args:
        into_functions: Whether to walk the bodies of functions inside `top`, too, which run at other times.
    """
    todo: list[tuple[ast.AST, list[ast.AST]]] = [(top, [])]
    while todo:
        node, parents = todo.pop()
        yield node, parents
        if into_functions or not parents or not isinstance(node, NESTED):
            around = [*parents, node]
            # Reversed, since the last one added is taken first.
            todo += [(child, around) for child in reversed(children_of(node))]


def is_nested(parents: Sequence[ast.AST]) -> bool:
    """Whether a node with these parents is in a function inside the walked one."""
    return any(isinstance(p, NESTED) for p in parents[1:])


def first_line(item: FunctionNode) -> int:
    """Return the first line of a function, decorators included, as in `co_firstlineno`."""
    return item.decorator_list[0].lineno if item.decorator_list else item.lineno


def last_name(expression: ast.expr) -> str:
    """Return the last part of a dotted name: `spin` of `rclpy.spin`; empty for any other expression."""
    match expression:
        case ast.Attribute(attr=name) | ast.Name(id=name):
            return name
    return ""


def blocks(node: ast.AST) -> Iterator[list[ast.stmt]]:
    """Yield the lists of statements directly below a node: its body, and what follows `else` and `finally`."""
    for _, value in ast.iter_fields(node):
        if isinstance(value, list) and value and isinstance(value[0], ast.stmt):
            yield value


class Syntax:
    """The syntax tree of one file, with an index of its parts.

    Args:
        module: The result of `ast.parse`.
    """

    def __init__(self, module: ast.Module) -> None:
        self.module = module
        self.parts: list[tuple[ast.AST, list[ast.AST]]] = []
        """Nodes that may use an attribute or a name of the module, with the nodes that enclose them."""
        self.classes: list[ast.ClassDef] = []
        self.functions: list[FunctionNode] = []
        self.nodes: set[ast.AST] = set()
        self.imported: set[str] = set()
        """Names of modules."""
        self.fresh: dict[FunctionNode, set[str]] = {}
        """Cache, by function: local names of messages that it has created or received."""
        for node, parents in walk(module):
            self.nodes.add(node)
            if isinstance(node, (ast.Attribute, ast.Global, ast.Call)):
                self.parts.append((node, parents))
            elif isinstance(node, ast.ClassDef):
                self.classes.append(node)
            elif isinstance(node, FunctionNode):
                self.functions.append(node)
            elif isinstance(node, ast.Import):
                self.imported |= {alias.asname or alias.name for alias in node.names}

    @cached_property
    def defined(self) -> set[str]:
        """Names of its classes and functions."""
        return {item.name for item in (*self.classes, *self.functions)}

    @cached_property
    def method_lines(self) -> set[int]:
        """First lines of the functions in its classes."""
        return {line for definition in self.classes for line in _function_lines(definition)}


def _function_lines(definition: ast.ClassDef) -> Iterator[int]:
    for node in nodes_in(definition):
        if isinstance(node, FunctionNode):
            yield first_line(node)
        elif isinstance(node, ast.Lambda):
            yield node.lineno


@cache
def syntax_of(file: str) -> Syntax:
    """Parse a file.

    Raises:
        OSError, SyntaxError, ValueError: The file cannot be read or parsed.
    """
    # It reads the encoding that the file declares, as Python does.
    with tokenize.open(file) as source:
        return Syntax(parsed(source.read()))


def loops_at(syntax: Syntax, first: int, line: int) -> list[ast.For | ast.While]:
    """Return the loops around a line, the innermost last.

    Args:
        first: The first line of the code that has the line, as in `co_firstlineno`.
    """
    return [
        loop
        for function in (*syntax.functions, syntax.module)
        if (first_line(function) if isinstance(function, FunctionNode) else 1) == first
        for loop in nodes_in(function)
        if isinstance(loop, (ast.For, ast.While)) and loop.lineno <= line <= (loop.end_lineno or 0)
    ]
