"""Parameters that only the constructor of a node reads, so that setting one has no effect.

A node may want it so. Hence nothing is said before somebody sets the parameter.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import NESTED, FunctionNode, last_name, nodes_in, syntax_of, walk
from graphflow.analysis.user_code import is_users_module
from graphflow.errors import Place
from graphflow.runtime.mistakes.source.shadowing import definition_of

_READING = ("get_parameter", "get_parameter_or")
_FOLLOWING = {
    *(f"add_{when}_set_parameters_callback" for when in ("pre", "on", "post")),
    *("ParameterEvent", "ParameterEventHandler", "get_parameters_by_prefix", "get_parameters", "getattr", "vars"),
}
"""Names in modules that may read parameters, or follow them, in another way."""


def without_effect(cls: type, name: str) -> str:
    """Return a sentence about a parameter that is read only in a constructor; "" if it may be read later."""
    first: Place | None = None
    is_period = False
    for parent in cls.__mro__:
        source = definition_of(parent) if is_users_module(parent.__module__) else None
        if source is None:
            continue
        definition, file = source
        known = {node: call for node, call in _early_names(definition) if node.value == name}
        for node in syntax_of(file).nodes:
            if isinstance(node, (ast.Name, ast.Attribute, ast.alias)) and _word(node) in _FOLLOWING:
                return ""
            if isinstance(node, ast.Constant) and node.value == name and node not in known:
                return ""
            if _reads_a_variable(node):
                return ""
        used = {node.value for node in nodes_in(definition) if isinstance(node, ast.Attribute)}
        reads = [call.lineno for call in known.values() if last_name(call.func) in _READING or call in used]
        if reads and first is None:
            first = Place(Path(file).name, min(reads))
            is_period = _is_period(definition, [call for call in known.values() if call.lineno == first.line])
    if first is None:
        return ""
    if is_period:
        way = "make a new one in a callback of add_on_set_parameters_callback, or start again with"
        way += f" --ros-args -p {name}:=VALUE"
        return f"{first}: {name!r} is set without effect, since a timer keeps its period; {way}"
    read = f"self.get_parameter({name!r}).value"
    return (
        f"{first}: {name!r} is set without effect, since only the constructor reads it; read {read} where it is used, "
        "or follow it with add_on_set_parameters_callback"
    )


def _is_period(definition: ast.ClassDef, reads: list[ast.Call]) -> bool:
    """Whether the period of a timer is computed from the results of some calls, directly or by variables."""
    nodes, kept = nodes_in(definition), set[str]()

    def comes_from_reads(value: ast.AST) -> bool:
        parts = nodes_in(value)
        return any(p in reads or (isinstance(p, (ast.Name, ast.Attribute)) and ast.unparse(p) in kept) for p in parts)

    for node in nodes:
        if isinstance(node, ast.Assign) and comes_from_reads(node.value):
            kept |= {ast.unparse(target) for target in node.targets}
    timers = [node for node in nodes if isinstance(node, ast.Call) and last_name(node.func) == "create_timer"]
    return any(comes_from_reads(timer.args[0]) for timer in timers if timer.args)


def _word(node: ast.Name | ast.Attribute | ast.alias) -> str:
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else node.name


def _early_names(definition: ast.ClassDef) -> Iterator[tuple[ast.Constant, ast.Call]]:
    """Yield the texts that calls in the constructor take, outside functions and endless loops within it."""
    methods = {item.name: item for item in definition.body if isinstance(item, FunctionNode)}
    for name in _early_methods(methods):
        for call, parents in walk(methods[name]):
            if isinstance(call, ast.Call) and not any(isinstance(p, (*NESTED, ast.While)) for p in parents[1:]):
                yield from ((part, call) for part in nodes_in(call) if isinstance(part, ast.Constant))


def _early_methods(methods: dict[str, FunctionNode]) -> set[str]:
    """Return the constructor, and the methods that only it calls."""
    users: dict[str, set[str]] = {}
    for name, method in methods.items():
        called = {id(node.func) for node in nodes_in(method) if isinstance(node, ast.Call)}
        for node in nodes_in(method):
            if isinstance(node, ast.Attribute) and is_own(node) and node.attr in methods:
                users.setdefault(node.attr, set()).add(name if id(node) in called else "")
    early = {"__init__"} & methods.keys()
    while more := {name for name, by in users.items() if by <= early} - early:
        early |= more
    return early


def _reads_a_variable(node: ast.AST) -> bool:
    """Whether a parameter is read whose name the source does not show."""
    match node:
        case ast.Call(func=ast.Attribute(attr="get_parameter" | "get_parameter_or"), args=[given, *_]):
            return not isinstance(given, ast.Constant)
    return False
