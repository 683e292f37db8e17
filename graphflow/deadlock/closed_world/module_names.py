"""What changes a value that a module holds, such as an array beside the node's class: which of its methods do.

The world is closed only as long as no other module can reach the value: neither holds it under a name of its own, nor
has imported the module.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from types import ModuleType

from graphflow.analysis.attribute_uses import Use, use_of
from graphflow.analysis.class_source import ClassSource, Unknown
from graphflow.analysis.local_messages import CONTAINER_MAKERS, is_new
from graphflow.analysis.syntax import FunctionNode, is_nested, syntax_of, walk
from graphflow.analysis.user_code import is_users_module
from graphflow.deadlock.closed_world.conditions import LOOKING, VIEWLESS, arrays


def changes(name: str, module_name: str, source: ClassSource) -> Iterator[Use]:
    """What the methods of a class do to a name of a module that may change its value.

    Raises:
        Unknown: Something else may change it.
    """
    module = sys.modules.get(module_name)
    if module is None or _is_known_elsewhere(name, module):
        raise Unknown
    is_array, known = isinstance(vars(module).get(name), arrays()), LOOKING | VIEWLESS
    methods = {function: method for method, functions in source.methods.items() for function in functions}
    for node, parents in walk(syntax_of(module.__file__ or "").module):
        if not (isinstance(node, ast.Name) and node.id == name):
            continue
        functions = [p for p in parents if isinstance(p, FunctionNode | ast.Lambda)]
        if any(_has_its_own(function, name) for function in functions):
            continue
        top = parents.index(functions[0]) if functions else 0
        method = next((methods[f] for f in functions[:1] if isinstance(f, FunctionNode) and f in methods), "")
        use = use_of(method, node, parents[top:])
        if use.kind == "read" or (use.kind == "part" and use.part is None):
            continue
        if not is_new(use.value, CONTAINER_MAKERS) or (is_array and use.kind == "called" and use.name not in known):
            raise Unknown
        if (use.kind == "called" and use.name in LOOKING) or (use.kind == "assigned" and not functions):
            continue
        if use.kind not in ("assigned", "changed", "called") or use.is_nested or not method:
            raise Unknown
        yield use


def _is_known_elsewhere(name: str, module: ModuleType) -> bool:
    """Whether another module holds the value, the module, or a package by which it can be reached."""
    path = module.__name__.split(".")
    way = [sys.modules.get(".".join(path[:length])) for length in range(1, len(path) + 1)]
    ways = {id(found) for found in (module, *way) if found is not None}
    value = vars(module).get(name)
    known = ways | ({id(value)} if type(value).__hash__ is None else set())  # what can be hashed is shared by many
    for other_name, other in list(sys.modules.items()):
        if id(other) in ways or not isinstance(other, ModuleType) or not _may_import(other_name):
            continue
        if not known.isdisjoint(map(id, list(vars(other).values()))):
            return True
    return False


def _may_import(module: str) -> bool:
    """Whether a module is one that could know of a user's."""
    return is_users_module(module) and module.partition(".")[0] not in sys.stdlib_module_names


def _has_its_own(function: FunctionNode | ast.Lambda, name: str) -> bool:
    """Whether a function means something else by a name."""
    given = [node.arg for node in ast.walk(function.args) if isinstance(node, ast.arg)]
    if name in given:
        return True
    nodes = [node for node, parents in walk(function) if not is_nested(parents)]  # those inside have their own, too
    if any(isinstance(node, ast.Global) and name in node.names for node in nodes):
        return False
    return any(isinstance(n, ast.Name) and n.id == name and isinstance(n.ctx, ast.Store) for n in nodes)
