"""Source files as syntax trees: what of each is kept, and that it is read once."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from graphflow.analysis.syntax import children_of, first_line, is_nested, nodes_in, syntax_of, walk

TEXT = """
import asyncio as aio, os

def helper(): ...

class N:
    @property
    def there(self):
        return self.ready

    def go(self):
        later = lambda: self.go()
"""


def test_walking_a_tree() -> None:
    """Every node comes once, with all that is around it, the outermost first."""
    tree = ast.parse("a.b")

    found = [(type(node).__name__, [type(p).__name__ for p in parents]) for node, parents in walk(tree)]
    assert ("Attribute", ["Module", "Expr"]) in found
    assert ("Name", ["Module", "Expr", "Attribute"]) in found
    assert len(found) == len(list(ast.walk(tree)))


def test_nodes_below() -> None:
    """In the order of `ast.walk`, each time they are asked for."""
    tree = ast.parse("def f(a):\n    return [g(a) for a in range(2)]\n")
    for _ in range(2):
        assert nodes_in(tree) == list(ast.walk(tree))
        assert children_of(tree.body[0]) == (*ast.iter_child_nodes(tree.body[0]),)


@pytest.fixture
def file(tmp_path: Path) -> str:
    """A file of its own for each test: what has been read is remembered."""
    path = tmp_path / "module.py"
    path.write_text(TEXT)
    return str(path)


def test_what_a_file_has(file: str) -> None:
    """Its classes and functions, the modules that it imports, and where methods begin, their decorators included."""
    syntax = syntax_of(file)
    assert [item.name for item in syntax.classes] == ["N"]
    assert sorted(item.name for item in syntax.functions) == ["go", "helper", "there"]
    assert syntax.defined == {"N", "go", "helper", "there"}
    assert syntax.imported == {"aio", "os"}
    assert syntax.method_lines == {7, 11, 12}
    assert {type(node) for node, _ in syntax.parts} == {ast.Attribute, ast.Call}
    assert {first_line(item) for item in syntax.functions} == {4, 7, 11}
    assert syntax_of(file) is syntax


def test_what_is_nested(file: str) -> None:
    """Something in a lambda of a method, but nothing of the method itself."""
    [go] = [item for item in syntax_of(file).functions if item.name == "go"]
    nested = {ast.unparse(node) for node, parents in walk(go) if isinstance(node, ast.expr) and is_nested(parents)}
    assert nested == {"self.go()", "self.go", "self"}


@pytest.mark.parametrize(("text", "error"), [(None, OSError), ("def", SyntaxError)])
def test_a_file_that_cannot_be_read(tmp_path: Path, text: str | None, error: type[Exception]) -> None:
    """It is an error, also the second time."""
    if text is not None:
        (tmp_path / "x.py").write_text(text)
    for _ in range(2):
        with pytest.raises(error):
            syntax_of(str(tmp_path / "x.py"))
