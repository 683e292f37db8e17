"""Methods that a class defines twice and passes as a callback twice, `callback` for two topics: the first is lost."""

from __future__ import annotations

import ast
from collections import Counter, defaultdict
from collections.abc import Iterator

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in

_TAKERS = ("create_subscription", "create_timer", "create_service", "add_done_callback", "ActionServer")


def defined_twice(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find the lines of methods that another replaces; each comes with a sentence.

    Methods with decorators, such as properties, may share a name on purpose, and a repeated copy changes nothing.
    """
    for definition in nodes_in(code):
        if isinstance(definition, ast.ClassDef):
            yield from _in_class(definition)


def _in_class(definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    bound = defaultdict[str, list[FunctionNode]](list)
    for item in definition.body:
        if isinstance(item, FunctionNode):
            bound[item.name].append(item)
    twice = {name: methods for name, methods in bound.items() if len(methods) > 1}
    uses = _passed(definition) if twice else Counter[str]()
    for name, (*lost, last) in twice.items():
        is_plain = not any(method.decorator_list for method in (*lost, last))
        is_other = any(ast.dump(method) != ast.dump(last) for method in lost)
        if uses[name] > 1 and is_plain and is_other:
            text = f"{definition.name} has another {name!r} in line {last.lineno}, which replaces this one"
            yield lost[0].lineno, f"{text}; rename one of the two"


def _passed(definition: ast.ClassDef) -> Counter[str]:
    """Count the calls that take each method as a callback."""
    calls = (n for n in nodes_in(definition) if isinstance(n, ast.Call) and last_name(n.func) in _TAKERS)
    given = (value for call in calls for value in (*call.args, *(keyword.value for keyword in call.keywords)))
    return Counter(value.attr for value in given if isinstance(value, ast.Attribute) and is_own(value))
