"""Publishers, timers and other entities that one line creates again and again, for example in each run of a callback.

ROS 2 keeps them all silently, until memory or processor time runs out.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import suppress
from types import CellType, FunctionType, MethodType
from typing import TYPE_CHECKING, Any

from graphflow.errors import Place
from rclpy.impl.callers import caller
from rclpy.impl.deadlock.stacks import is_in_run
from rclpy.impl.mistakes.hidden_callbacks import warn_of_hiding
from rclpy.impl.mistakes.origins import Origin
from rclpy.impl.nodes import internals_of
from rclpy.timer import Timer

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.service import Service
    from rclpy.subscription import Subscription


MANY = 10
"""The number of live entities of one kind, name and line that is reported."""
MANY_TIMERS = 5
"""The same for timers that a callback creates: each of its runs adds one, and all go on."""
MANY_SUBSCRIPTIONS = 3
"""The same for subscriptions with one callback, which handles every message as often."""
MANY_APART = 50
"""The same for timers whose callbacks have values of their own."""
_KINDS = {
    "create_publisher": "publishers",
    "create_subscription": "subscriptions",
    "create_client": "clients",
    "create_service": "services",
    "create_timer": "timers",
}
_reported: set[Place] = set()
"""The lines that have been reported."""
logger = logging.getLogger("graphflow")


def count(node: Node, call: str, made: Any) -> None:
    """Warn if a node has many entities like the one that a call has just created.

    Args:
        call: The name of the method.
    """
    asked = caller(2) if call in _KINDS else None
    if asked is None:
        return
    kind, place = _KINDS[call], asked.place
    if call == "create_service":
        _warn_of_twin(node, made, place)
    elif call == "create_subscription":
        _warn_of_same(node, made, place)
    is_again = is_in_run(asked.frame)
    is_once = asked.frame.f_code.co_name == "__init__" and not is_again
    # A constructor makes as many timers as it wants, so each counts as one of its own.
    name = made if is_once and kind == "timers" else _name(made, is_again=is_again)
    made.made_at = origin = Origin(place, asked.frame.f_code, name)
    if call in ("create_subscription", "create_service", "create_timer"):
        warn_of_hiding(node, made, asked.frame.f_code, _with_callbacks(node))
    alike = [other for other in getattr(internals_of(node), kind) if other.made_at == origin and _is_alive(other)]
    is_often = call == "create_subscription" and _is_heard_often(made, alike)
    many = MANY_TIMERS if is_again and kind == "timers" else MANY
    if (len(alike) >= many or is_often) and place not in _reported:
        if len(alike) < MANY_APART and kind == "timers" and len(set(map(_bound, alike))) == len(alike):
            return  # each is for something else, such as one turtle of several
        _reported.add(place)
        owner, what = node.get_fully_qualified_name(), f"{kind}{_of(made)}"
        way = f"create one in __init__, and keep it in an attribute{_for_delay(made)}"
        logger.warning("%s has %d %s created in %s: %s", owner, len(alike), what, place, way)


def _with_callbacks(node: Node) -> list[Timer | Subscription | Service]:
    own = internals_of(node)
    return [*own.subscriptions, *own.timers, *own.services]


def _warn_of_twin(node: Node, made: Service, place: Place) -> None:
    """Warn if a node already has a service of that name: both servers are called, and one answer wins by chance."""
    same = [other for other in internals_of(node).services if other is not made and _topic(other) == _topic(made)]
    former = same[0].made_at if same else None
    if former is not None and place not in _reported:
        _reported.add(place)
        text = "%s offers %s twice, in %s and in %s: each call reaches both, and the first answer counts; keep one"
        logger.warning(text, node.get_fully_qualified_name(), _topic(made), former.place, place)


def _warn_of_same(node: Node, made: Any, place: Place) -> None:
    """Warn if a node already has a subscription with that topic and callback: each message is handled twice."""
    for other in internals_of(node).subscriptions:
        is_same = other is not made and _topic(other) == _topic(made) and other.callback == made.callback
        former = other.made_at if is_same and other.raw is made.raw else None
        if former is not None and former.place != place and place not in _reported:
            _reported.add(place)
            text = "%s subscribes %s to %s twice, in %s and in %s: each message is handled twice; keep one"
            called = getattr(made.callback, "__name__", repr(made.callback))
            logger.warning(text, node.get_fully_qualified_name(), called, _topic(made), former.place, place)


def _name(made: Any, *, is_again: bool) -> object:
    """Return the name by which entities count as equal; timers of a loop in `__init__` may share a callback's line."""
    if isinstance(made, Timer):
        return getattr(made.callback, "__code__", made.callback) if is_again else made.callback
    return _topic(made)


def _bound(timer: Timer) -> tuple[int, ...]:
    """Return the identities of the values that a timer's callback has kept: defaults and variables around it."""
    if not isinstance(timer.callback, FunctionType):
        return ()
    defaults, cells = timer.callback.__defaults__ or (), timer.callback.__closure__ or ()
    return tuple(id(value) for value in (*defaults, *(value for cell in cells for value in _held(cell))))


def _held(cell: CellType) -> Iterator[object]:
    """Yield the value of a variable around a function, unless it has none yet."""
    with suppress(ValueError):  # as in `timer = create_timer(1.0, lambda: timer.cancel())`
        yield cell.cell_contents


def _topic(made: Any) -> str:
    return str(getattr(made, "topic_name", None) or made.service_name)


def _of(made: Any) -> str:
    if isinstance(made, Timer):
        return f" of {name}" if (name := getattr(made.callback, "__name__", "")) else ""
    return f" of {_topic(made)}"


def _is_heard_often(made: Subscription, alike: list[Subscription]) -> bool:
    return sum(other.callback == made.callback for other in alike) >= MANY_SUBSCRIPTIONS


def _for_delay(made: Any) -> str:
    """Return the other remedy for a timer: it may be meant to run once."""
    if not isinstance(made, Timer):
        return ""
    called = f"self.{made.callback.__name__}()" if isinstance(made.callback, MethodType) else "..."
    period = made.timer_period_ns / 1e9
    way = f"timer = self.create_timer({period:g}, lambda: (timer.cancel(), {called}))"
    return f"; one that should run once cancels itself: {way}"


def _is_alive(other: object) -> bool:
    return not isinstance(other, Timer) or not (other.handle.is_destroyed or other.is_canceled())
