"""Changes of a module-level value, such as an array next to the node's class, by methods of the class.

The world is closed only if no other module can reach the value: none has a name for it, and none has imported the
module.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from types import ModuleType

from graphflow.analysis.attribute_uses import Use, use_of
from graphflow.analysis.class_source import ClassSource, Unknown
from graphflow.analysis.local_messages import CONTAINER_MAKERS, is_new
from graphflow.analysis.syntax import FunctionNode, is_nested, nodes_in, syntax_of, walk
from graphflow.analysis.user_code import is_users_module
from graphflow.deadlock.closed_world.values import LOOKING, VIEWLESS, arrays


def changes(name: str, module_name: str, source: ClassSource) -> Iterator[Use]:
    """Yield the uses of a module's name, in methods of a class, that may change its value.

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
    """Whether another module has a name for the value, the module, or a package that leads to it."""
    path = module.__name__.split(".")
    way = [sys.modules.get(".".join(path[:length])) for length in range(1, len(path) + 1)]
    ways = {id(found) for found in (module, *way) if found is not None}
    value = vars(module).get(name)
    # A hashable value (a number, a string) may be shared by chance, and cannot change itself.
    known = ways | ({id(value)} if type(value).__hash__ is None else set())
    for other_name, other in list(sys.modules.items()):
        if id(other) in ways or not isinstance(other, ModuleType) or not _may_import(other_name):
            continue
        if not known.isdisjoint(map(id, list(vars(other).values()))):
            return True
    return False


def _may_import(module: str) -> bool:
    """Whether a module could import a user's: it is no part of the standard library or of graphflow."""
    return is_users_module(module) and module.partition(".")[0] not in sys.stdlib_module_names


def _has_its_own(function: FunctionNode | ast.Lambda, name: str) -> bool:
    """Whether a name is local to a function."""
    given = [node.arg for node in nodes_in(function.args) if isinstance(node, ast.arg)]
    if name in given:
        return True
    nodes = [node for node, parents in walk(function) if not is_nested(parents)]  # inner functions have their own scope
    if any(isinstance(node, ast.Global) and name in node.names for node in nodes):
        return False
    return any(isinstance(n, ast.Name) and n.id == name and isinstance(n.ctx, ast.Store) for n in nodes)
