"""The closed world of a node and of the objects it owns, such as a navigator with an event of its own.

An object is part of the closed world if the node creates it, keeps it in one attribute, and passes it to no other code.
A wait inside the object then ends through calls of its methods by the node, or through the node's own access to its
attributes.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

from graphflow.analysis.attribute_uses import Use
from graphflow.analysis.class_source import ClassSource, Unknown, source_of
from graphflow.analysis.frames import Frame
from graphflow.analysis.syntax import nodes_in
from graphflow.analysis.user_code import is_users, is_users_module, is_users_object
from graphflow.deadlock.asyncio_frames import is_inside, object_wait
from graphflow.deadlock.closed_world.loops import Loop, is_library, only_pauses
from graphflow.deadlock.closed_world.values import TOOLS
from graphflow.deadlock.closed_world.wakers import (
    BEGINNINGS,
    Question,
    Setters,
    entries_of,
    handlers_above,
)
from graphflow.deadlock.protocols import Subject

_HARMLESS = ("builtins", "typing", "abc")
"""Modules whose base classes call no methods of a user's subclass."""
_MADE_BY = {"__init__", "__post_init__"}
"""Methods that run while an object is created."""


def setters(frames: list[Frame], waiter: object, node: Subject, *, is_bounded: bool = False) -> Setters | None:
    """Return the code that can end a wait; None if it is not known.

    Args:
        frames: The frames of the coroutine that waits, the outermost first.
        waiter: The future that it waits for; None if a thread or the event loop itself waits.
        is_bounded: Whether the wait has a deadline.
    """
    try:
        question = _question(frames, node)
        is_bounded = is_bounded or question.is_bounded
        if is_bounded and question.is_repeated:  # a timeout only starts the next turn, so the loop's condition counts
            return question.of_loop()
        found = question.of_object(waiter) or question.of_loop()
        return found and found._replace(gives_up=is_bounded)
    except (Unknown, SyntaxError, TypeError, ValueError, AttributeError, RecursionError):
        return None  # the source is missing, or contains something that the analysis does not expect


def _question(frames: list[Frame], node: Subject) -> Question:
    """Return the question of a wait: about the node, or about an object that it owns and in which it waits."""
    for frame in reversed(frames):
        if only_pauses(frame):
            continue
        innermost = frame.f_locals.get("self")
        if innermost is node.instance or not (is_library(frame) or is_users(frame.f_code.co_filename)):
            break
        held = [name for name, value in vars(node.instance).items() if value is innermost]
        if held and is_users_object(innermost):
            return OwnedQuestion(frames, node, held[0], innermost)
    things = [wait.thing for wait in map(object_wait, frames) if wait is not None]
    # The node's own method may wait for an event that lies in an object, such as a dataclass.
    for name, value in vars(node.instance).items() if things else ():
        if is_users_object(value) and any(is_inside(part, t) for part in vars(value).values() for t in things):
            return OwnedQuestion(frames, node, name, value)
    return NodeQuestion(frames, node)


class NodeQuestion(Question):
    """The question about a wait in a method of the node, which may poll objects that it owns."""

    def _changing_owned(self, owner: str, names: set[str], loop: Loop, below: set[str]) -> set[str]:
        question = OwnedQuestion([], self._node, owner, getattr(self._instance, owner))
        return question.changing(names, loop, below)


class OwnedQuestion(Question):
    """The question about a wait in an object that the node owns."""

    def __init__(self, frames: list[Frame], node: Subject, owner: str, held: object) -> None:
        if not all(is_users_module(cls.__module__) or cls.__module__ in _HARMLESS for cls in type(held).__mro__):
            raise Unknown  # a foreign base class may call its methods, as that of a node calls handlers
        self.owner = owner
        super().__init__(frames, node, held)
        self._read: set[str] = set()
        """Attributes of the object that decide the wait."""
        self._endings: tuple[str, ...] = ()

    def _uses(self, name: str) -> Iterator[Use]:
        self._read.add(name)
        return super()._uses(name)

    def _changes(self, name: str) -> Iterator[Use]:
        self._read.add(name)
        return super()._changes(name)

    def changing(self, names: set[str], loop: Loop, below: set[str]) -> set[str]:
        """Return the methods that change attributes of the object which a loop of the node's polls.

        Args:
            names: The attributes.
            below: The methods of the node that the loop calls, and those that they call.

        Raises:
            Unknown: Something else does, or the loop itself.
        """
        source, inside = source_of(self._node.instance), set(nodes_in(loop))
        own = [use for use in source.uses(self.owner) if use.syntax in inside or use.method in below]
        run = {name for use in own if use.name in self._source.methods for name in self._source.below(use.name)}
        changing = {use.method for name in names for use in self._changes(name)}
        is_own = any(use.kind == "changed" and use.name in names and self._ends(use, source) for use in own)
        if is_own or changing & run or self._source.may_fail(loop, run):
            raise Unknown
        return self._ending(changing) | self._called_back(self._own_ending(changing))

    def _reached(self, what: str, methods: Iterable[str]) -> Setters | None:
        what = what.replace("self.", f"self.{self.owner}.")
        found = handlers_above(what, self._ending(methods), self._node)
        called = self._called_back(self._own_ending(methods))
        if not called:
            return found
        return Setters(what, called) if found is None else found._replace(handlers=found.handlers | called)

    def _called_back(self, methods: set[str]) -> frozenset[str]:
        """Return which methods of the object are callbacks of the node's, as in `rate.fire`.

        Raises:
            Unknown: One of them may be called by another node.
        """
        found = {f"{self.owner}.{name}" for name in methods} & entries_of(self._node)
        for name in methods:
            given = sum(use.is_lent or use.is_registered for use in self._source.uses(name))
            if given > (f"{self.owner}.{name}" in found):
                raise Unknown
        return frozenset(found)

    def _own_ending(self, methods: Iterable[str]) -> set[str]:
        """Return the methods of the object that end the wait, and those that call them."""
        return self._source.above(set(methods) - _MADE_BY, set(self._source.methods), self.owner)

    def _ending(self, methods: Iterable[str]) -> set[str]:
        """Return the methods of the node that end the wait: through the object's methods, or by access to its parts.

        Raises:
            Unknown: The node does not own the object, or other code may do so.
        """
        ending = self._own_ending(methods)
        source = source_of(self._node.instance)
        uses = source.uses(self.owner)
        if source.foreign(self.owner) or any(self._escapes(use, ending) for use in uses):
            raise Unknown
        return {
            use.method
            for use in uses
            if (use.kind == "called" and use.name in ending)
            or (use.kind == "changed" and use.name in self._read and self._ends(use, source))
        }

    def _escapes(self, use: Use, ending: set[str]) -> bool:
        """Whether a use of the object lets other code end the wait, or hides who does."""
        match use.kind:
            case "given" | "invoked" | "entered":
                return True
            case "assigned":
                is_made = use.method in BEGINNINGS and isinstance(use.value, ast.Call)
                return use.is_nested or not is_made
            case "called":
                return use.is_nested or use.name not in self._source.methods
            case "part":  # a method that is passed on, or a property
                is_passed_on = use.part is not None and use.name in self._read
                return use.is_nested or is_passed_on or use.name in ending
            case "changed":
                return use.is_nested or (use.part is not None and use.name in self._read)
        return use.is_nested

    def _ended(self, name: str, thing: object, methods: tuple[str, ...]) -> Setters | None:
        self._endings = methods
        return super()._ended(name, thing, methods)

    def _ends(self, use: Use, source: ClassSource) -> bool:
        """Whether a method of the node does something to a part of the object that can end the wait."""
        nodes = [n for function in source.methods.get(use.method, []) for n in nodes_in(function)]
        parts = {n for n in nodes if isinstance(n, ast.Attribute) and n.value is use.syntax}
        called = {n.attr for n in nodes if isinstance(n, ast.Attribute) and n.value in parts}
        value = getattr(self._instance, use.name, None)
        endings = self._endings or next((methods for tool, methods in TOOLS.items() if isinstance(value, tool)), ())
        return not (endings and called) or bool(called & {*endings})
