"""Lists of a class that two of its nodes in one process change: `points = []` in the class body.

Python makes one list for the class. Nodes may share one on purpose; hence nothing is said of a list that the code
reaches through the class, that its name or a comment calls shared, or in which nodes register themselves.
"""

from __future__ import annotations

import ast
import linecache
import logging
import re
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from typing import NamedTuple

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, nodes_in, syntax_of, walk
from graphflow.analysis.user_code import is_users_module
from graphflow.errors import Place
from graphflow.runtime.mistakes.source.project_words import other_modules
from graphflow.runtime.mistakes.source.shadowing import definition_of

logger = logging.getLogger("graphflow")

_KINDS = (list, set, deque)
"""Types of attributes that are told; a dict may well be a cache, which nodes share with profit."""
_CHANGING = {
    "append",
    "appendleft",
    "extend",
    "insert",
    "add",
    "update",
    "pop",
    "popleft",
    "remove",
    "discard",
    "clear",
}
_ON_PURPOSE = re.compile(
    r"shared?|all|every|each|common|class|instances|registry|cache|pool|global|process", re.IGNORECASE
)
"""Words in a name, or in a comment beside it, by which sharing is meant."""


class _Shared(NamedTuple):
    attribute: str
    value: object
    """The object that belongs to the class."""
    text: str
    """The statement."""
    place: Place


def shared_attributes(instance: object, others: Sequence[tuple[str, object]]) -> list[str]:
    """Return a sentence for each list of its class that a node shares with another.

    Args:
        instance: The node.
        others: The full names and the instances of the other nodes of its process.
    """
    relatives = [(name, other) for name, other in others if _is_related(type(instance), type(other))]
    try:
        return [*_shared(instance, relatives)] if relatives else []
    except Exception as error:  # a bug in these checks must not keep a node from running
        logger.debug("the attributes of %s were not checked", type(instance).__name__, exc_info=error)
        return []


def _is_related(cls: type, other: type) -> bool:
    return any(is_users_module(parent.__module__) for parent in {*cls.__mro__} & {*other.__mro__} - {object})


def _shared(instance: object, others: Iterable[tuple[str, object]]) -> Iterator[str]:
    cls: type = type(instance)
    for shared in _changed(cls):
        for name, other in others:
            if _is_its_own(instance, shared) and _is_its_own(other, shared):
                kind = type(shared.value).__name__
                yield (
                    f"{shared.place}: `{shared.text}` in the class is one {kind} for all of its nodes, and {name} in "
                    f"this process changes it, too; write self.{shared.text} in __init__"
                )
                break


def _is_its_own(instance: object, shared: _Shared) -> bool:
    """Whether a node uses the object of the class."""
    is_set = shared.attribute in getattr(instance, "__dict__", {})
    return not is_set and getattr(type(instance), shared.attribute, None) is shared.value


@cache
def _changed(cls: type) -> tuple[_Shared, ...]:
    """Return the lists of a class and its parents that only their methods change, through `self`."""
    sources = [
        (parent, *source)
        for parent in cls.__mro__
        if is_users_module(parent.__module__) and (source := definition_of(parent)) is not None
    ]
    found: list[_Shared] = []
    for parent, definition, file in sources:
        for name, text, line in _assigned(definition):
            value = vars(parent).get(name)
            if type(value) not in _KINDS or _is_meant(name, file, line):
                continue
            definitions = [definition for _, definition, _ in sources]
            if not _is_changed(name, definitions) or _is_reached(name, sources):
                continue
            found.append(_Shared(name, value, text, Place(file, line)))
    return tuple(found)


def _assigned(definition: ast.ClassDef) -> Iterator[tuple[str, str, int]]:
    """Yield the attributes that a class body assigns, each with its statement and line."""
    for item in definition.body:
        match item:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                yield name, f"{name} = {ast.unparse(value)}", item.lineno
            case ast.AnnAssign(target=ast.Name(id=name), annotation=type_, value=ast.expr() as value):
                if "ClassVar" not in ast.unparse(type_):
                    yield name, f"{name} = {ast.unparse(value)}", item.lineno


def _is_meant(name: str, file: str, line: int) -> bool:
    """Whether a name, or the text beside its assignment, says that nodes share it."""
    if name.isupper() or name.startswith("__"):
        return True
    beside = [linecache.getline(file, number).strip() for number in (line - 1, line, line + 1)]
    comments = [text.partition("#")[2] for text in beside]
    docstrings = [text for text in beside if text.startswith(('"', "'"))]
    return any(_ON_PURPOSE.search(text) for text in (name, *comments, *docstrings))


def _is_changed(name: str, definitions: Iterable[ast.ClassDef]) -> bool:
    """Whether methods change an attribute of `self` in place, and none sets it or registers the node in it."""
    is_changed = False
    for definition in definitions:
        for method in definition.body:
            for node, _ in walk(method) if isinstance(method, FunctionNode) else ():
                match node:
                    case ast.Attribute(attr=attr, ctx=ast.Store() | ast.Del()) if attr == name:
                        return False
                    case ast.Call(func=ast.Attribute(value=ast.Attribute(attr=attr) as owner, attr=way), args=args) if (
                        attr == name and is_own(owner) and way in _CHANGING
                    ):
                        if any(isinstance(argument, ast.Name) and argument.id == "self" for argument in args):
                            return False
                        is_changed = True
    return is_changed


def _is_reached(name: str, sources: Iterable[tuple[type, ast.ClassDef, str]]) -> bool:
    """Whether some code of the project reaches an attribute through a class."""
    classes = {parent.__name__ for parent, _, _ in sources} | {"cls", "type(self)", "__class__"}
    files = {file for _, _, file in sources}
    modules = {syntax_of(file).module for file in files} | {
        module for file in files for module in other_modules(file, name)
    }
    return any(
        isinstance(node, ast.Attribute) and node.attr == name and ast.unparse(node.value).rpartition(".")[2] in classes
        for module in modules
        for node in nodes_in(module)
    )
