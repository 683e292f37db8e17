"""Comparisons that never hold: a bool parameter with `"true"`, a missing choice, the status of a goal with text."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple, get_args

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.bindings import Bindings, bindings_of
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk
from graphflow.interface import Parameter
from graphflow.names import did_you_mean, nearest
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.declare import Param
from graphflow.runtime.endpoints.events import QosEventKind

_NUMBERS = {"bool": "a bool", "int": "an int", "float": "a float"}
_TRUE, _FALSE = ("true", "yes", "on", "1"), ("false", "no", "off", "0")


class _Comparison(NamedTuple):
    """A comparison of an expression with constants, one of which it should equal."""

    line: int
    subject: ast.expr
    constants: Sequence[object]
    parents: list[ast.AST]
    is_negated: bool


def never_equal(cls: type, owner: type, definition: ast.ClassDef, module: ast.Module) -> Iterator[tuple[int, str]]:
    """Find the lines of a class with such a comparison; each comes with its correction.

    Args:
        cls: The class of the nodes.
        owner: The class itself, or the parent of it that `definition` defines.
    """
    declarations, own = declared.declarations(cls), declared.declarations(owner)
    # A subclass may declare the parameter anew, with other choices.
    params = {k: v.parameter for k, v in declarations.items() if isinstance(v, Param) and own.get(k) is v}
    words = {node.attr for node in nodes_in(definition) if isinstance(node, ast.Attribute)}
    if words.isdisjoint({*params, "parameters", "status", "lifecycle_state", "kind"}):
        return
    bindings = bindings_of(module)
    for found in _comparisons(module, definition):
        if (parameter := _parameter(found.subject, params)) is not None:
            text = _unfit(ast.unparse(found.subject), parameter, found)
        else:
            text = _of_enum(found, cls, bindings)
        if text:
            yield found.line, text


def _comparisons(module: ast.Module, definition: ast.ClassDef) -> Iterator[_Comparison]:
    for node, parents in walk(module):
        if next((p for p in reversed(parents) if isinstance(p, ast.ClassDef)), None) is not definition:
            continue
        match node:
            case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq() as op], comparators=[right]):
                for subject, other in ((left, right), (right, left)):
                    if isinstance(other, ast.Constant):
                        yield _Comparison(node.lineno, subject, [other.value], parents, isinstance(op, ast.NotEq))
            case ast.Compare(
                left=left,
                ops=[ast.In() | ast.NotIn() as op],
                comparators=[ast.Tuple(elts=others) | ast.List(elts=others) | ast.Set(elts=others)],
            ) if others and all(isinstance(other, ast.Constant) for other in others):
                constants = [other.value for other in others if isinstance(other, ast.Constant)]
                yield _Comparison(node.lineno, left, constants, parents, isinstance(op, ast.NotIn))
            case ast.Match(subject=subject, cases=cases):
                for case in cases:
                    match case.pattern:
                        case ast.MatchValue(value=ast.Constant(value=value) as constant):
                            yield _Comparison(constant.lineno, subject, [value], [*parents, node], False)


def _parameter(subject: ast.expr, params: Mapping[str, Parameter]) -> Parameter | None:
    """Return the parameter that an expression reads."""
    match subject:
        case ast.Attribute(attr=name) if is_own(subject):
            return params.get(name)
        case ast.Call(func=function, args=[ast.Constant(value=str(name))]) if (
            ast.unparse(function) == "self.parameters.get"
        ):
            return next((parameter for parameter in params.values() if parameter.name == name), None)
    return None


def _unfit(shown: str, parameter: Parameter, found: _Comparison) -> str:
    """Return a sentence if a parameter never equals any of the constants; "" if it may."""
    constants = found.constants
    if parameter.dynamic:
        return ""
    listed = " or ".join(map(repr, constants))
    if kind := _NUMBERS.get(parameter.type):
        if not all(isinstance(constant, str) for constant in constants):
            return ""
        return f"{shown} is {kind}, which never equals {listed}{_number(shown, parameter, found)}"
    if parameter.type != "str":
        return ""
    if not all(isinstance(constant, str) for constant in constants):
        if any(isinstance(constant, str) or constant is None for constant in constants):
            return ""
        return f"{shown} is a str, which never equals {listed}; compare it with a text, in quotes"
    if parameter.choices and not set(constants) & {"", *parameter.choices}:  # "" stands for none, and does no harm
        choices = " or ".join(map(repr, parameter.choices))
        near = nearest(str(constants[0]), parameter.choices) if len(constants) == 1 else None
        return f"{shown} is {choices}, and never {listed}" + (f"; did you mean {near!r}?" if near is not None else "")
    return ""


def _number(shown: str, parameter: Parameter, found: _Comparison) -> str:
    """Return the comparison that was meant; "" if that is not clear."""
    text = str(found.constants[0]).strip()
    if len(found.constants) > 1:
        return ""
    if parameter.type == "bool":
        word = text.lower()
        is_true = word in _TRUE
        if not is_true and word not in _FALSE:
            return ""
        return f"; write {shown if is_true != found.is_negated else f'not {shown}'}"
    try:
        float(text)
    except ValueError:
        return ""
    return f"; write {text} without quotes"


def _of_enum(found: _Comparison, cls: type, bindings: Bindings) -> str:
    """Return a sentence if the status of a goal, or the state of a lifecycle node, is compared with text."""
    if not all(isinstance(constant, str) for constant in found.constants):
        return ""
    match found.subject:
        case ast.Attribute(value=ast.Name(id=name), attr="kind") if _is_event(name, cls, found.parents):
            kinds = get_args(QosEventKind)
            listed, shown = " or ".join(map(repr, found.constants)), ast.unparse(found.subject)
            if not set(found.constants) & {*kinds}:
                near = did_you_mean(str(found.constants[0]), kinds) or f"; it is one of {', '.join(kinds)}"
                return f"{shown} is never {listed}{near}"
        case ast.Attribute(value=(ast.Name() | ast.Attribute()) as goal, attr="status"):
            return _never_text(found, "GoalStatus") if _is_goal(goal, bindings, found.parents) else ""
        case ast.Attribute(attr="lifecycle_state") if is_own(found.subject):
            owner = next((parent for parent in cls.__mro__ if "lifecycle_state" in vars(parent)), None)
            return (
                _never_text(found, "LifecycleState") if owner is not None and owner.__name__ == "LifecycleNode" else ""
            )
    return ""


def _is_event(name: str, cls: type, parents: Sequence[ast.AST]) -> bool:
    """Whether a name is the argument of a method that is called with events of an endpoint."""
    method = next((parent for parent in reversed(parents) if isinstance(parent, FunctionNode)), None)
    if method is None or len(method.args.args) < 2 or method.args.args[1].arg != name:
        return False
    annotation = method.args.args[1].annotation
    return method.name in declared.event_hooks(cls) or (annotation is not None and last_name(annotation) == "QosEvent")


def _never_text(found: _Comparison, enum: str) -> str:
    from graphflow.machines.goal import GoalStatus  # most nodes need neither
    from graphflow.machines.lifecycle import LifecycleState

    members = list((GoalStatus if enum == "GoalStatus" else LifecycleState).__members__)
    name = str(found.constants[0]).upper().removeprefix("STATUS_").removeprefix("PRIMARY_STATE_")
    member = name if name in members else "SUCCEEDED" if enum == "GoalStatus" else "ACTIVE"
    shown, is_ = ast.unparse(found.subject), "is not" if found.is_negated else "is"
    text = f"{shown} is a {enum}, which never equals {' or '.join(map(repr, found.constants))}"
    return f"{text}; write {shown} {is_} {enum}.{member}"


def _is_goal(named: ast.expr, bindings: Bindings, parents: Sequence[ast.AST]) -> bool:
    """Whether a name is bound to a goal that was sent, and to nothing else."""
    if isinstance(named, ast.Name):
        items = [item for p in parents if isinstance(p, ast.AsyncWith) for item in p.items]
        for item in items:
            if isinstance(item.optional_vars, ast.Name) and item.optional_vars.id == named.id:
                return isinstance(item.context_expr, ast.Call) and last_name(item.context_expr.func) == "send"
    values = [value.expression for value in bindings.of(named, parents)]
    values = [value for value in values if not (isinstance(value, ast.Constant) and value.value is None)]
    return bool(values) and all(
        isinstance(value, ast.Await)
        and isinstance(value.value, ast.Call)
        and last_name(value.value.func) == "send_goal"
        for value in values
    )
