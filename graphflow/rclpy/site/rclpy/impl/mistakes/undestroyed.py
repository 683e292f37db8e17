"""Calls such as `destroy_timer(self.tick)`, whose argument is not of the kind they destroy; ROS 2 only returns False.

Entities that are destroyed already, or another node's, are not reported; neither is None, which clean-up code passes.
"""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, Any

from graphflow.errors import Place
from rclpy.client import Client
from rclpy.guard_condition import GuardCondition
from rclpy.impl.callers import caller
from rclpy.impl.nodes import internals_of
from rclpy.publisher import Publisher
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Rate, Timer

if TYPE_CHECKING:
    from rclpy.node import Node


_KINDS: dict[str, tuple[type, str]] = {
    "destroy_publisher": (Publisher, "publishers"),
    "destroy_subscription": (Subscription, "subscriptions"),
    "destroy_client": (Client, "clients"),
    "destroy_service": (Service, "services"),
    "destroy_timer": (Timer, "timers"),
    "destroy_guard_condition": (GuardCondition, "guards"),
    "destroy_rate": (Rate, ""),
}
"""The class that each call destroys, and the node's list of them."""
_reported: set[Place] = set()
"""The lines that have been reported."""
logger = logging.getLogger("graphflow")


def warn(node: Node, thing: object, call: str, depth: int) -> None:
    """Warn, once per line, if a call has destroyed nothing because its argument is of another kind.

    Args:
        call: The name of the method.
        depth: The number of frames between the caller's and the program's.
    """
    kind, asked = _KINDS[call][0], caller(depth + 1)
    if thing is None or asked is None or isinstance(thing, kind) or asked.place in _reported:
        return
    _reported.add(asked.place)
    text = "%s: %s destroys nothing, since it takes a %s and got %s; write %s"
    logger.warning(text, asked.place, call, kind.__name__, _shown(thing), _right_call(node, thing, call))


def _shown(thing: object) -> str:
    if isinstance(thing, type):
        return f"the class {thing.__name__}"
    if callable(thing) and (name := getattr(thing, "__name__", "")):
        return f"the {'method' if hasattr(thing, '__self__') else 'function'} {name}"
    if isinstance(thing, (str, int, float)):
        return repr(thing)
    name = type(thing).__name__
    return f"{'an' if name[:1] in 'AEIOU' else 'a'} {name}"


def _right_call(node: Node, thing: object, call: str) -> str:
    """Return the call that was probably meant."""
    other = next((name for name, (kind, _) in _KINDS.items() if isinstance(thing, kind)), None)
    if other is not None:
        return f"{other}(...)"
    if callable(getattr(thing, "destroy", None)) and not isinstance(thing, type):
        return f"{_attribute(node, thing) or '...'}.destroy()"
    kept = _attribute(node, next((own for own in _owned(node, call) if _belongs(node, own, thing)), None))
    if kept:
        return f"{call}({kept})"
    what = call.removeprefix("destroy_")
    return f"{call}(self.{what}), with what create_{what} has returned"


def _owned(node: Node, call: str) -> list[object]:
    return list(getattr(internals_of(node), _KINDS[call][1], ()))


def _belongs(node: Node, own: object, thing: Any) -> bool:
    """Whether an entity of the node's has that callback, or that name."""
    if not isinstance(thing, str):
        return bool(getattr(own, "callback", None) == thing)
    if (name := getattr(own, "topic_name", None)) is not None:
        return bool(name == node.resolve_topic_name(thing))
    return bool(getattr(own, "service_name", None) == thing)


def _attribute(node: Node, thing: object) -> str:
    """Return the node's attribute that holds a value, as `self.timer`; empty if there is none."""
    found = next((name for name, value in vars(node).items() if value is thing and thing is not None), "")
    return f"self.{found}" if found else ""
