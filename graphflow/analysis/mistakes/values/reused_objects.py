"""Objects that are appended to a list again and again, so that the list has one object many times."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from graphflow.analysis.syntax import FunctionNode, blocks, last_name, nodes_in, walk

_SETUP = ("__init__", "on_start", "on_configure")


def reused_objects(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find the lines that append an object that was changed and not made anew; each comes with a sentence.

    Found are a local variable that is made outside the loop, and an attribute of a node that a handler changes.
    """
    found: dict[int, str] = {}
    for node in nodes_in(code):
        if isinstance(node, ast.ClassDef) and any(last_name(base).endswith("Node") for base in node.bases):
            handlers = [m for m in node.body if isinstance(m, FunctionNode) and m.name not in _SETUP]
            for handler in handlers:
                found |= _appended(handler, handlers, of_node=True)
        elif isinstance(node, (ast.For, ast.AsyncFor, ast.While)):
            found |= _appended(node, [node], of_node=False)
    yield from found.items()


def _appended(repeated: ast.AST, makers: Sequence[ast.AST], *, of_node: bool) -> dict[int, str]:
    """Find such lines in code that is repeated.

    Args:
        makers: The code that could make the object anew.
        of_node: Whether to look for attributes of a node only.
    """
    changers = makers if of_node else [repeated]  # another handler may change it
    changed = {name for changer in changers for node in nodes_in(changer) for name in _changed_by(node)}
    made = {name for maker in makers for node in nodes_in(maker) for name in _made_by(node)}
    found: dict[int, str] = {}
    for node, parents in walk(repeated):
        match node:
            case ast.Call(func=ast.Attribute(value=into, attr="append"), args=[ast.Name() | ast.Attribute() as one]):
                name, target = ast.unparse(one), ast.unparse(into)
                parts = target.split(".")
                lists = {".".join(parts[:count]) for count in range(1, len(parts) + 1)}
                is_new = name in made or lists & made or name not in changed
                if not is_new and (not of_node or name.startswith("self.")) and not _ends(parents):
                    text = f"{target} gets the same {name} each time, so that all of its items show the last change"
                    found[node.lineno] = f"{text}; append a new one"
    return found


def _changed_by(node: ast.AST) -> Iterator[str]:
    """Yield the objects of which a node sets an attribute: `a.b` and `a` for `a.b.c = 1`."""
    if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
        owner: ast.expr = node.value
        while isinstance(owner, ast.Attribute):
            yield ast.unparse(owner)
            owner = owner.value
        yield ast.unparse(owner)


def _made_by(node: ast.AST) -> Iterator[str]:
    """Yield the names that a node sets, the lists that it empties, and the objects that it looks for in a list."""
    match node:
        case ast.Name(ctx=ast.Store()) | ast.Attribute(ctx=ast.Store()):
            yield ast.unparse(node)
        case ast.ExceptHandler(name=str(name)):
            yield name
        case ast.Call(func=ast.Attribute(value=emptied, attr="clear" | "pop" | "popleft")):
            yield ast.unparse(emptied)
        case ast.Compare(left=one, ops=[ast.In() | ast.NotIn()]):
            yield ast.unparse(one)


def _ends(parents: Sequence[ast.AST]) -> bool:
    """Whether the loop ends after a call with these parents."""
    statement = next(p for p in reversed(parents) if isinstance(p, ast.stmt))
    block = next(block for parent in reversed(parents) for block in blocks(parent) if statement in block)
    after = block[block.index(statement) :]
    return any(isinstance(s, (ast.Break, ast.Return, ast.Raise)) for s in after)
