"""Source files as syntax trees, each read and walked once however many classes it has."""

from __future__ import annotations

import ast
import tokenize
from collections.abc import Iterator, Sequence
from functools import cache, cached_property

FunctionNode = ast.FunctionDef | ast.AsyncFunctionDef
NESTED = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)


def walk(top: ast.AST) -> Iterator[tuple[ast.AST, list[ast.AST]]]:
    """Every node below one, with what encloses it, the outermost first."""
    todo: list[tuple[ast.AST, list[ast.AST]]] = [(top, [])]
    while todo:
        node, parents = todo.pop()
        yield node, parents
        todo += [(child, [*parents, node]) for child in ast.iter_child_nodes(node)]


def is_nested(parents: Sequence[ast.AST]) -> bool:
    """Whether something is in a function inside what was walked."""
    return any(isinstance(p, NESTED) for p in parents[1:])


def first_line(item: FunctionNode) -> int:
    """Where a function begins, its decorators included, as its code says too."""
    return item.decorator_list[0].lineno if item.decorator_list else item.lineno


class Syntax:
    """One file.

    Args:
        module: What `ast.parse` makes of it.
    """

    def __init__(self, module: ast.Module) -> None:
        self.module = module
        self.parts: list[tuple[ast.AST, list[ast.AST]]] = []
        """What may do something to an attribute or a name of the module, with what encloses it."""
        self.classes: list[ast.ClassDef] = []
        self.functions: list[FunctionNode] = []
        self.nodes: set[ast.AST] = set()
        self.imported: set[str] = set()
        """Names that stand for modules."""
        self.fresh: dict[FunctionNode, set[str]] = {}
        """By function, as far as that was asked for: local names of messages that it has made or received."""
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
        """The names of its classes and functions."""
        return {item.name for item in (*self.classes, *self.functions)}

    @cached_property
    def method_lines(self) -> set[int]:
        """Where the functions in its classes begin."""
        return {line for definition in self.classes for line in _function_lines(definition)}


def _function_lines(definition: ast.ClassDef) -> Iterator[int]:
    for node in ast.walk(definition):
        if isinstance(node, FunctionNode):
            yield first_line(node)
        elif isinstance(node, ast.Lambda):
            yield node.lineno


@cache
def syntax_of(file: str) -> Syntax:
    """The syntax of a file. Raises OSError, SyntaxError or ValueError if it cannot be read."""
    with tokenize.open(file) as source:
        return Syntax(ast.parse(source.read()))
