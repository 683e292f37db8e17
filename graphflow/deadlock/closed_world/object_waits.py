"""What ends a wait in a method of the node, or in an object that the node holds, such as a navigator of its own.

The object belongs to the closed world if the node has made it, keeps it in one attribute, and gives it to nobody.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from typing import Any

from graphflow.analysis.attribute_uses import Use
from graphflow.analysis.class_source import ClassSource, Unknown, source_of
from graphflow.analysis.frames import Frame
from graphflow.analysis.user_code import is_users, is_users_module, is_users_object
from graphflow.deadlock.asyncio_frames import is_inside, object_wait
from graphflow.deadlock.closed_world.conditions import TOOLS, Loop
from graphflow.deadlock.closed_world.wakers import (
    BEGINNINGS,
    Question,
    Setters,
    handlers_above,
    is_library,
    only_pauses,
)
from graphflow.deadlock.protocols import Subject

_HARMLESS = ("builtins", "typing", "abc")
"""Modules that are not the user's and whose classes call no methods of those that inherit from them."""
_MADE_BY = {"__init__", "__post_init__"}
"""Methods that make an object."""


def setters(frames: list[Frame], waiter: Any, node: Subject, *, is_bounded: bool = False) -> Setters | None:
    """What can end a wait; None when that is not known.

    Args:
        frames: The frames of the coroutine that waits, the outermost first.
        waiter: The future that it waits for, if a coroutine waits.
        is_bounded: Whether the wait is given up after some time.
    """
    try:
        question = _question(frames, node)
        is_bounded = is_bounded or question.is_bounded
        if is_bounded and question.is_repeated:  # what matters is when it stops trying again
            return question.of_loop()
        found = question.of_object(waiter) or question.of_loop()
        return found and found._replace(gives_up=is_bounded)
    except (Unknown, SyntaxError, TypeError, ValueError, AttributeError, RecursionError):  # or no source to be read
        return None


def _question(frames: list[Frame], node: Subject) -> Question:
    """What ends a wait in a method of the node, or of an object that it holds and knows alone."""
    for frame in reversed(frames):
        if only_pauses(frame):
            continue
        innermost = frame.f_locals.get("self")
        if innermost is node.instance or not (is_library(frame) or is_users(frame.f_code.co_filename)):
            break
        held = [name for name, value in vars(node.instance).items() if value is innermost]
        if held and is_users_object(innermost):
            return HeldQuestion(frames, node, held[0], innermost)
    things = [wait.thing for wait in map(object_wait, frames) if wait is not None]
    for name, value in vars(node.instance).items() if things else ():  # a dataclass of the node's with an event in it
        if is_users_object(value) and any(is_inside(part, t) for part in vars(value).values() for t in things):
            return HeldQuestion(frames, node, name, value)
    return NodeQuestion(frames, node)


class NodeQuestion(Question):
    """Asks what ends a wait in a method of the node, which may poll objects that it holds."""

    def _changing_held(self, owner: str, names: set[str], loop: Loop, below: set[str]) -> set[str]:
        held = HeldQuestion([], self._node, owner, getattr(self._instance, owner))
        return held.changing(names, loop, below)


class HeldQuestion(Question):
    """What ends a wait in an object that the node holds in one attribute, made by the node, and given to nobody."""

    def __init__(self, frames: list[Frame], node: Subject, owner: str, held: object) -> None:
        if not all(is_users_module(cls.__module__) or cls.__module__ in _HARMLESS for cls in type(held).__mro__):
            raise Unknown  # the class that it inherits from may call its methods, as that of a node calls handlers
        self.owner = owner
        super().__init__(frames, node, held)
        self._looked: set[str] = set()
        self._endings: tuple[str, ...] = ()

    def _uses(self, name: str) -> Iterator[Use]:
        self._looked.add(name)
        return super()._uses(name)

    def _changes(self, name: str) -> Iterator[Use]:
        self._looked.add(name)
        return super()._changes(name)

    def changing(self, names: set[str], loop: Loop, below: set[str]) -> set[str]:
        """The methods of the node that change attributes of the object, which a loop of the node's polls.

        Args:
            names: The attributes.
            below: The methods of the node that the loop calls, and those that they call.

        Raises:
            Unknown: Something else does, or the loop itself.
        """
        source, inside = source_of(self._node.instance), set(ast.walk(loop))
        own = [use for use in source.uses(self.owner) if use.syntax in inside or use.method in below]
        run = {name for use in own if use.name in self._source.methods for name in self._source.below(use.name)}
        changing = {use.method for name in names for use in self._changes(name)}
        is_own = any(use.kind == "changed" and use.name in names and self._ends(use, source) for use in own)
        if is_own or changing & run or self._source.may_fail(loop, run):
            raise Unknown
        return self._ending(changing)

    def _reached(self, what: str, methods: Iterable[str]) -> Setters | None:
        return handlers_above(what.replace("self.", f"self.{self.owner}."), self._ending(methods), self._node)

    def _ending(self, methods: Iterable[str]) -> set[str]:
        """The methods of the node that end the wait: by the object's methods, or in the object itself."""
        known = set(self._source.methods)
        ending = self._source.above(set(methods) - _MADE_BY, known, self.owner)
        source, found = source_of(self._node.instance), set[str]()
        if source.foreign(self.owner):
            raise Unknown
        for use in source.uses(self.owner):
            if use.kind in ("given", "invoked", "entered") or use.is_nested:
                raise Unknown
            if use.kind == "assigned" and (use.method not in BEGINNINGS or not isinstance(use.value, ast.Call)):
                raise Unknown
            if use.kind == "called" and use.name not in known:
                raise Unknown
            if use.kind in ("changed", "part") and use.name in self._looked:
                if use.part is not None:
                    raise Unknown
                if use.kind == "changed" and self._ends(use, source):
                    found.add(use.method)
            if use.kind == "part" and use.name in ending:  # a method that is handed on, or a property
                raise Unknown
            if use.kind == "called" and use.name in ending:
                found.add(use.method)
        return found

    def _ended(self, name: str, thing: Any, methods: tuple[str, ...]) -> Setters | None:
        self._endings = methods
        return super()._ended(name, thing, methods)

    def _ends(self, use: Use, source: ClassSource) -> bool:
        """Whether what a method of the node does to a part of the object can end the wait."""
        nodes = [n for function in source.methods.get(use.method, []) for n in ast.walk(function)]
        parts = {n for n in nodes if isinstance(n, ast.Attribute) and n.value is use.syntax}
        called = {n.attr for n in nodes if isinstance(n, ast.Attribute) and n.value in parts}
        value = getattr(self._instance, use.name, None)
        endings = self._endings or next((methods for tool, methods in TOOLS.items() if isinstance(value, tool)), ())
        return not (endings and called) or bool(called & {*endings})
