"""Callbacks of a class that a subclass overrides by accident, with a method that it gives to an entity of its own.

Python calls the subclass's method for both entities, so the base class's work is no longer done.
"""

from __future__ import annotations

import dis
import logging
from collections.abc import Iterator
from types import CodeType, FunctionType, MethodType
from typing import TYPE_CHECKING

from graphflow.analysis.user_code import is_users, short_place
from rclpy.constants import S_TO_NS
from rclpy.subscription import Subscription
from rclpy.timer import Timer

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.service import Service


_reported: set[CodeType] = set()
"""The callbacks that have been reported."""
_STUBS = {"NotImplementedError", "NotImplemented", "ABC"}
"""The names that a callback meant to be overridden uses, at most."""
logger = logging.getLogger("graphflow")


def warn_of_hiding(
    node: Node, made: Timer | Subscription | Service, caller: CodeType, others: list[Timer | Subscription | Service]
) -> None:
    """Warn if a base class and its subclass each gave an entity a method of the same name.

    Args:
        made: The new entity, with the callback.
        caller: The function that created it.
        others: The node's entities with callbacks.
    """
    callback = made.callback
    if not isinstance(callback, MethodType) or callback.__self__ is not node:
        return
    method = callback.__func__
    if not isinstance(method, FunctionType) or method.__code__ in _reported:
        return
    for other in others:
        is_gone = isinstance(other, Timer) and (other.handle.is_destroyed or other.is_canceled())
        if other is made or is_gone or other.callback != callback or other.made_at is None:
            continue
        outer = other.made_at.code
        for first, first_by, by in ((other, outer, caller), (made, caller, outer)):
            found = _hidden(type(node), method, first_by, by)
            if found is not None and _is_missed(type(node), method, found[1], first, made, other):
                _reported.add(method.__code__)
                logger.warning("%s", _text(method, *found, first, _kinds(made, other)))
                return


def _hidden(
    cls: type, method: FunctionType, outer: CodeType, inner: CodeType
) -> tuple[type, FunctionType, type] | None:
    """Return the class that defines a method, the parent's method it hides, and the parent; None if it hides none.

    Args:
        outer: The function that must be of the parent.
        inner: The function that must be of the class itself, or of one below.
    """
    name = method.__name__
    mro = list(cls.__mro__)
    owner = next((c for c in mro if vars(c).get(name) is method), None)
    parent, child = _owner(cls, outer), _owner(cls, inner)
    if owner is None or parent is None or child is None:
        return None
    at = mro.index(owner)
    if mro.index(child) > at or mro.index(parent) <= at:
        return None
    for base in mro[at + 1 :]:
        former = vars(base).get(name)
        if isinstance(former, FunctionType) and is_users(former.__code__.co_filename):
            return owner, former, base
    return None


def _owner(cls: type, code: CodeType) -> type | None:
    """Return the class that defines a function."""
    return next((c for c in cls.__mro__ if any(getattr(v, "__code__", None) is code for v in vars(c).values())), None)


def _is_missed(
    cls: type, method: FunctionType, former: FunctionType, first: object, *entities: Timer | Subscription | Service
) -> bool:
    """Whether the parent's method was meant to be called as well.

    A method that is a stub, or that the new one calls, is meant to be overridden. Where both entities have messages of
    one type, one method for both may be meant, unless it leaves alone what the parent's sets for other methods.
    """
    if method.__name__ in method.__code__.co_names or set(former.__code__.co_names) <= _STUBS:
        return False
    if isinstance(first, Timer) or len({_type(entity) for entity in entities}) > 1:
        return True
    lost = _named(former.__code__, "STORE_ATTR") - _named(method.__code__, "STORE_ATTR")
    codes = (c for c in _codes(cls) if c not in (former.__code__, method.__code__))
    return any(lost & _named(code, "LOAD_ATTR") for code in codes)


def _type(entity: Timer | Subscription | Service) -> object:
    if isinstance(entity, Timer):
        return None
    return entity.msg_type if isinstance(entity, Subscription) else entity.srv_type


def _codes(cls: type) -> Iterator[CodeType]:
    for owner in cls.__mro__:
        for value in vars(owner).values():
            code = getattr(value, "__code__", None)
            if code is not None and is_users(code.co_filename):
                yield code


def _named(code: CodeType, operation: str) -> set[str]:
    """Return the attributes that some code stores or loads."""
    return {str(step.argval) for step in dis.get_instructions(code) if step.opname == operation}


def _text(
    method: FunctionType,
    owner: type,
    former: FunctionType,
    parent: type,
    first: Timer | Subscription | Service,
    kinds: str,
) -> str:
    name = method.__name__
    own, its = (short_place(f.__code__.co_filename, f.__code__.co_firstlineno) for f in (method, former))
    return (
        f"{owner.__name__}.{name} ({own}) hides {parent.__name__}'s ({its}), which {_use(first)}; "
        f"{kinds} call {owner.__name__}'s: give it another name"
    )


def _use(entity: Timer | Subscription | Service) -> str:
    """Describe an entity's use of its callback, to follow `which`."""
    if isinstance(entity, Timer):
        return f"is called every {entity.timer_period_ns / S_TO_NS:g} s"
    if isinstance(entity, Subscription):
        return f"is subscribed to {entity.topic_name}"
    return f"answers {entity.service_name}"


def _kinds(*entities: object) -> str:
    words = {
        "timers" if isinstance(e, Timer) else "topics" if isinstance(e, Subscription) else "services" for e in entities
    }
    return f"both {words.pop()}" if len(words) == 1 else "both"
