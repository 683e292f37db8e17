"""Options that the environment, a graph file or a command line, gives to a node under construction.

They travel in a context variable, so that a class whose `__init__(self)` takes nothing, as ROS 2 teaches it, gets its
name, remaps and parameters too. They take precedence over the values in the class.
"""

from __future__ import annotations

import inspect
from collections.abc import Container, Iterator, Mapping, Sequence
from contextvars import ContextVar
from dataclasses import dataclass, field, is_dataclass
from typing import Any, TypeVar

from graphflow.analysis.user_code import short_place
from graphflow.errors import DeclarationError
from graphflow.interface import may_make
from graphflow.machines.regrouping import Regrouping
from graphflow.names import Remap, Resolver, did_you_mean, rule_hint
from graphflow.runtime.args import is_number_or_truth
from graphflow.runtime.callables import code_of
from graphflow.runtime.mistakes.slow_hooks import warn_slow_init

T = TypeVar("T")

_NAMES = ("name", "node_name")
"""Names of an `__init__`'s first argument that takes the node's name."""


@dataclass(frozen=True)
class NodeOptions:
    """The options of one node.

    Attributes:
        name: The node's name; None for the class's choice.
        namespace: The node's namespace; None for the class's choice.
        remaps: Remap rules, which precede the class's own.
        overrides: Parameter values, each with the place that gives it.
        concurrency: The graph file's changes to the groups.
        rosout: Whether log records are published on /rosout.
    """

    name: str | None = None
    namespace: str | None = None
    remaps: Sequence[Remap] = ()
    overrides: Mapping[str, tuple[Any, str]] = field(default_factory=dict)
    concurrency: Regrouping = field(default_factory=Regrouping)
    rosout: bool = True


NOTHING = NodeOptions()
_given: ContextVar[tuple[type, NodeOptions] | None] = ContextVar("graphflow_options", default=None)


def make_within(cls: type[T], options: NodeOptions, default_name: str) -> T:
    """Make a node of a class with these options.

    Args:
        default_name: The name for an `__init__` that requires one, if the options have none.

    Raises:
        DeclarationError: Its `__init__` needs more than a name, or does not call its parent's.
        Exception: The error that its `__init__` raises.
    """
    reason = why_not(cls)
    if reason:
        raise DeclarationError(reason)
    arguments = (options.name or default_name,) if _required(cls) else ()
    token = _given.set((cls, options))
    try:
        with warn_slow_init(cls):
            return cls(*arguments)
    finally:
        _given.reset(token)


def take(node: object) -> NodeOptions:
    """Return the options for a node under construction; other nodes that it makes get none."""
    given = _given.get()
    if given is None or given[0] is not type(node):
        return NOTHING
    _given.set(None)
    return given[1]


def _init(cls: type) -> Any:
    """Return the function of a class's `__init__`, without its wrappers."""
    return inspect.unwrap(cls.__init__)  # type: ignore[misc]


def without_super(cls: type) -> str:
    """Return the sentence for a class whose `__init__` does not call its parent's."""
    if is_dataclass(cls):
        return f"leave out @dataclass above {cls.__name__}, whose __init__ it replaces; write word = Param(...)"
    code = code_of(_init(cls))
    place = "" if code is None else f" ({short_place(code.co_filename, code.co_firstlineno)})"
    return f"{cls.__name__}.__init__{place} must call super().__init__()"


def why_not(cls: type) -> str:
    """Return the reason why nodes of a class cannot be made, as a sentence; "" if they can."""
    init = _init(cls)
    code = code_of(init)
    is_ours = init.__module__.startswith("graphflow.")
    if code is not None and not is_ours and not {"super", "__init__"} & {*code.co_names, *code.co_freevars}:
        return without_super(cls)
    required = _required(cls)
    if required[:1] and required[0] in _NAMES:
        del required[0]
    if not required:
        return ""
    several = len(required) > 1
    first = required[0]
    return (
        f"{cls.__name__}.__init__ needs {' and '.join(required)}, and nodes are made without arguments: give "
        f"{'them defaults' if several else 'it a default'}, or declare a parameter in the class: {first} = Param(...)"
    )


def _required(cls: type) -> list[str]:
    """Return the names of an `__init__`'s required arguments."""
    parameters = list(inspect.signature(cls.__init__).parameters.values())[1:]  # type: ignore[misc]
    kinds = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    return [p.name for p in parameters if p.default is p.empty and p.kind not in kinds]


def unused_remaps(
    names: Resolver, own: Container[str], dynamic: bool | Sequence[str], parameters: Container[str]
) -> Iterator[str]:
    """Return a sentence for each remap rule of a node that has matched nothing.

    Args:
        own: Names that every node has, which are not suggested.
        dynamic: Names that the class makes at run time, possibly later.
        parameters: The node's parameters, which a rule may have been meant to set.
    """
    known = [r.given for r in names.derivations.values() if r.given not in own]
    for rule in names.unused():
        is_value = rule.match in parameters and is_number_or_truth(rule.replacement)
        may_be_made = may_make(dynamic, names.full(rule.match)) if "*" not in rule.match else dynamic
        if may_be_made and not is_value:
            continue
        name = rule.match[1:] if rule.match.startswith("_") else rule.match  # ROS 1's syntax for a parameter
        is_param = name in parameters
        set_by = f"-p {name}:={rule.replacement}"
        if (former := names.taken_by(rule)) is not None:
            yield f"the remap {rule} comes too late: {former} has renamed {rule.match} already; remove one of the two"
            continue
        hint = f"; to set the parameter write {set_by}" if is_param else rule_hint(rule.match, rule.replacement, known)
        if rule.match in (names.full_name, names.name):
            hint = f"; to rename the node write __node:={rule.replacement.rpartition('/')[2]}"
        hint = hint or did_you_mean(rule.match, known)
        yield f"the remap {rule} matches no name of this node{hint}"
