"""Publishers, timers and other entities that one line creates again and again, for example in each run of a callback.

ROS 2 keeps them all silently, until memory or processor time runs out.
"""

from __future__ import annotations

import logging
from typing import Any

from graphflow.errors import Place
from rclpy.impl.callers import caller
from rclpy.impl.deadlock.stacks import is_in_run
from rclpy.impl.mistakes.hidden_callbacks import tell_hidden
from rclpy.timer import Timer

MANY = 10
"""The number of live entities of one kind, name and line that is reported."""
_KINDS = {
    "create_publisher": "publishers",
    "create_subscription": "subscriptions",
    "create_client": "clients",
    "create_service": "services",
    "create_timer": "timers",
}
_told: set[Place] = set()
"""The lines that have been reported."""
logger = logging.getLogger("graphflow")


def count(node: Any, call: str, made: Any) -> None:
    """Warn if a node has many entities like the one that a call has just created.

    Args:
        call: The name of the method.
    """
    asked = caller(2) if call in _KINDS else None
    if asked is None:
        return
    kind, place = _KINDS[call], asked.place
    if call == "create_service":
        _tell_twin(node, made, place)
    elif call == "create_subscription":
        _tell_same(node, made, place)
    made.made_at = key = (place, asked.frame.f_code, _name(made, is_again=is_in_run(asked.frame)))
    if hasattr(made, "callback"):
        tell_hidden(node, made, asked.frame.f_code, _with_callbacks(node))
    alike = sum(getattr(other, "made_at", None) == key and _is_alive(other) for other in getattr(node._graphflow, kind))
    if alike >= MANY and place not in _told:
        _told.add(place)
        what = f"{kind}{_of(made)}"
        text = "%s has %d %s by now that were made in %s: make one in __init__, and keep it in an attribute"
        logger.warning(text, node.get_fully_qualified_name(), alike, what, place)


def _with_callbacks(node: Any) -> list[object]:
    own = node._graphflow
    return [*own.subscriptions, *own.timers, *own.services]


def _tell_twin(node: Any, made: Any, place: Place) -> None:
    """Warn if a node already has a service of that name: both servers are called, and one answer wins by chance."""
    same = [other for other in node._graphflow.services if other is not made and _topic(other) == _topic(made)]
    former = getattr(same[0], "made_at", None) if same else None
    if former is not None and place not in _told:
        _told.add(place)
        text = "%s offers %s twice, in %s and in %s: each call reaches both, and the first answer counts; keep one"
        logger.warning(text, node.get_fully_qualified_name(), _topic(made), former[0], place)


def _tell_same(node: Any, made: Any, place: Place) -> None:
    """Warn if a node already has a subscription with that topic and callback: each message is handled twice."""
    for other in node._graphflow.subscriptions:
        is_same = other is not made and _topic(other) == _topic(made) and other.callback == made.callback
        former = getattr(other, "made_at", None) if is_same and other.raw is made.raw else None
        if former is not None and former[0] != place and place not in _told:
            _told.add(place)
            text = "%s subscribes %s to %s twice, in %s and in %s: each message comes twice; keep one"
            called = getattr(made.callback, "__name__", repr(made.callback))
            logger.warning(text, node.get_fully_qualified_name(), called, _topic(made), former[0], place)


def _name(made: Any, *, is_again: bool) -> object:
    """Return the name by which entities count as equal; timers of a loop in `__init__` may share a callback's line."""
    if isinstance(made, Timer):
        return getattr(made.callback, "__code__", made.callback) if is_again else made.callback
    return _topic(made)


def _topic(made: Any) -> str:
    return str(getattr(made, "topic_name", None) or made.service_name)


def _of(made: Any) -> str:
    if isinstance(made, Timer):
        return f" of {name}" if (name := getattr(made.callback, "__name__", "")) else ""
    return f" of {_topic(made)}"


def _is_alive(other: object) -> bool:
    return not isinstance(other, Timer) or not (other.handle.is_destroyed or other.is_canceled())
