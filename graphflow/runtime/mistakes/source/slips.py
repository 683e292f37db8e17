"""Slips in a node class's source that Python runs without an error, but that have no effect or fail late.

Examples are a handler without its decorator, `self.rat = 2.0` beside a parameter `rate`, `Talker.rate = 2.0` in place
of `self.rate`, `message.dat = ...` or a string for a number in a message, `self.close` without parentheses, and
callbacks that return a method or see the last value of a loop.
"""

from __future__ import annotations

import ast
import logging
import sys
from collections.abc import Iterator
from functools import cache

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.mistakes import native_source
from graphflow.analysis.syntax import FunctionNode, nodes_in, syntax_of
from graphflow.analysis.user_code import is_users_module
from graphflow.analysis.words import words_in
from graphflow.errors import Place
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.declare import Param
from graphflow.runtime.mistakes.source.endless_waits import endless_waits, has_attribute
from graphflow.runtime.mistakes.source.idle_methods import idle_methods
from graphflow.runtime.mistakes.source.lost_updates import lost_updates
from graphflow.runtime.mistakes.source.never_equal import never_equal
from graphflow.runtime.mistakes.source.overridden import overridden
from graphflow.runtime.mistakes.source.project_words import other_modules
from graphflow.runtime.mistakes.source.shadowing import definition_of
from graphflow.runtime.mistakes.source.stray_attributes import stray_attributes
from graphflow.runtime.mistakes.source.uncancelled import uncancelled
from graphflow.runtime.mistakes.source.unrepeated import unrepeated
from graphflow.runtime.mistakes.source.without_super import without_super
from graphflow.runtime.mistakes.source.wrong_fields import (
    flags_of,
    messages_kept,
    resolved,
    whole_messages,
    wrong_fields,
)
from graphflow.runtime.mistakes.source.wrong_units import wrong_units

logger = logging.getLogger("graphflow")


@cache
def slips(cls: type) -> tuple[str, ...]:
    """Return a sentence with its place for each slip of a class and of its bases in user code."""
    try:
        return tuple(_slips(cls))
    except Exception as error:  # a bug in these checks must not keep a node from running
        logger.debug("the source of %s was not checked", cls.__name__, exc_info=error)
        return ()


@cache
def slips_in_groups(cls: type) -> tuple[str, ...]:
    """Return the same for slips that the groups of the class do not prevent; a graph file's groups may."""
    try:
        return tuple(
            f"{Place(file, line)}: {text}"
            for parent, definition, file in _sources(cls)
            for line, text in lost_updates(cls, parent, definition, syntax_of(file).module)
        )
    except Exception as error:  # as above
        logger.debug("the source of %s was not checked", cls.__name__, exc_info=error)
        return ()


def _sources(cls: type) -> Iterator[tuple[type, ast.ClassDef, str]]:
    """Yield a class and its bases in user code, each with its source and file."""
    for parent in cls.__mro__:
        source = definition_of(parent) if is_users_module(parent.__module__) else None
        if source is not None:
            yield parent, *source


def _slips(cls: type) -> Iterator[str]:
    for parent, definition, file in _sources(cls):
        module = syntax_of(file).module
        space = vars(sys.modules[parent.__module__])
        yield from idle_methods(parent, definition, file, module, space)
        yield from stray_attributes(cls, definition, file, words_in(module))
        yield from _replaced(cls, definition, file, space)
        yield from _changed_in_place(cls, definition, file)
        flags, kept = flags_of(cls, definition), messages_kept(definition, space)
        for method in definition.body:
            if isinstance(method, FunctionNode):
                handler = declared.handlers(parent).get(method.name)
                yield from wrong_fields(method, handler, file, space, kept)
                yield from whole_messages(flags, method, handler, file, space)
        module = syntax_of(file).module
        handlers = declared.handlers(parent).items()
        subscribed = {name: handler.type.__name__ for name, handler in handlers if handler.kind == "subscription"}
        found = [
            *native_source.slips(definition, module, subscribed),
            *overridden(parent, definition),
            *wrong_units(cls, definition),
            *without_super(parent, definition),
            *unrepeated(parent, definition),
            *uncancelled(parent, definition),
            *never_equal(cls, parent, definition, module),
        ]
        for line, name, text in endless_waits(cls, definition, module):
            if not name or not any(has_attribute(other, name) for other in other_modules(file, name)):
                found.append((line, text))
        yield from (f"{Place(file, line)}: {text}" for line, text in found)


def _replaced(cls: type, definition: ast.ClassDef, file: str, space: dict[str, object]) -> Iterator[str]:
    """Find declarations that a method replaces by setting a class attribute instead of the node's."""
    names = declared.declarations(cls)
    for method in definition.body:
        for node in nodes_in(method) if isinstance(method, FunctionNode) else ():
            match node:
                case ast.Attribute(value=owner, attr=name, ctx=ast.Store()) if name in names:
                    if resolved(owner, space) in cls.__mro__ or ast.unparse(owner) in _OWN_CLASS:
                        text = f"{ast.unparse(node)} replaces what the class declares, for all of its nodes"
                        yield f"{Place(file, node.lineno)}: {text}; write self.{name}"


def _changed_in_place(cls: type, definition: ast.ClassDef, file: str) -> Iterator[str]:
    """Find list parameters that are modified in place: no check and no tool sees the change."""
    lists = {
        name
        for name, p in declared.declarations(cls).items()
        if isinstance(p, Param) and p.parameter.type.startswith("list[")
    }
    for method in definition.body:
        for node in nodes_in(method) if isinstance(method, FunctionNode) else ():
            match node:
                case (
                    ast.Call(func=ast.Attribute(value=ast.Attribute(attr=name) as changed, attr=way))
                    | ast.Subscript(value=ast.Attribute(attr=name) as changed, ctx=ast.Store() | ast.Del(), slice=way)
                ) if name in lists and is_own(changed) and (way in _CHANGING or isinstance(way, ast.expr)):
                    text = f"{ast.unparse(node)} changes a parameter's list without its checks, and no tool sees it"
                    yield f"{Place(file, node.lineno)}: {text}; set a new one, as in self.{name} = [*self.{name}, ...]"


_CHANGING = ("append", "extend", "insert", "remove", "pop", "clear", "sort", "reverse")
_OWN_CLASS = ("type(self)", "self.__class__")
