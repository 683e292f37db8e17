"""Filters for messages: caching, and synchronization of several topics by time.

Source: the Python API of message_filters.
"""

from __future__ import annotations

import logging
import sys
import threading
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from itertools import product
from typing import Any

from graphflow.analysis.user_code import short_place, users_frame
from rclpy.clock import ROSClock
from rclpy.duration import Duration
from rclpy.impl.mistakes.unmatched_stamps import Unmatched
from rclpy.logging import get_logger
from rclpy.subscription import Subscription
from rclpy.time import Time

UNHEARD = 3
"""Times that a synchronizer without a callback drops a set of messages before it warns."""
logger = logging.getLogger("graphflow")

__all__ = ["ApproximateTimeSynchronizer", "Cache", "SimpleFilter", "Subscriber", "TimeSynchronizer"]


class SimpleFilter:
    """The base class of filters: passes messages to callbacks, among them other filters."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., object], tuple[object, ...]]] = {}

    def registerCallback(self, cb: Callable[..., object], *args: object) -> int:  # noqa: N802 - its name there
        """Register `cb`, called with each output message followed by `args`; return its number."""
        number = len(self.callbacks)
        self.callbacks[number] = (cb, args)
        return number

    def signalMessage(self, *msg: object) -> None:  # noqa: N802 - its name there
        """Pass messages to the callbacks."""
        for callback, args in list(self.callbacks.values()):
            callback(*msg, *args)


class Subscriber(SimpleFilter):
    """A filter of a topic's messages. Takes the node and the arguments of `create_subscription` except the callback."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__()
        if len(args) < 3 or not hasattr(args[0], "create_subscription"):
            raise TypeError("Subscriber takes the node first: Subscriber(self, LaserScan, 'scan')")
        self.node, self.topic = args[0], args[2]
        kwargs.setdefault("qos_profile", 10)
        self.sub = self.node.create_subscription(*args[1:], self.callback, **kwargs)

    def callback(self, msg: object) -> None:
        """Pass on an incoming message."""
        self.signalMessage(msg)

    def getTopic(self) -> str:  # noqa: N802 - its name there
        """Return the topic as it was given."""
        topic: str = self.topic
        return topic

    def __getattr__(self, key: str) -> Any:
        """Return an attribute of the subscription."""
        return getattr(self.__dict__["sub"], key)


def _connected(f: Any, who: object, callback: Callable[..., object], *args: object) -> int:
    """Connect a callback to a filter's output.

    Raises:
        AttributeError: It is not a filter, but for example a subscription.
    """
    if isinstance(f, Subscription):
        kind, name = type(who).__name__, f.msg_type.__name__
        made = f"message_filters.Subscriber(self, {name}, {f.topic_name!r})"
        raise AttributeError(f"{kind} takes filters, not subscriptions; write {made}")
    number: int = f.registerCallback(callback, *args)
    return number


class Cache(SimpleFilter):
    """A cache of a filter's last messages, by time.

    Args:
        f: The filter.
        cache_size: The number of messages to keep.
        allow_headerless: Whether to keep messages without a header as well, by time of arrival.
    """

    def __init__(self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False) -> None:
        super().__init__()
        self.cache_size, self.allow_headerless = cache_size, allow_headerless
        self.cache_msgs: list[object] = []
        self.cache_times: list[Time] = []
        self.connectInput(f)

    def connectInput(self, f: SimpleFilter) -> None:  # noqa: N802 - its name there
        """Connect a filter as the input."""
        self.incoming_connection = _connected(f, self, self.add)

    def add(self, msg: Any) -> None:
        """Keep a message, and pass it on."""
        stamp = _stamp(msg, self.allow_headerless, "message_filters_cache")
        if stamp is None:
            return
        self.cache_msgs.append(msg)
        self.cache_times.append(stamp)
        del self.cache_msgs[: -self.cache_size], self.cache_times[: -self.cache_size]
        self.signalMessage(msg)

    def getInterval(self, from_stamp: Time, to_stamp: Time) -> list[Any]:  # noqa: N802 - its name there
        """Return the messages of a closed time interval."""
        assert from_stamp <= to_stamp
        return [msg for msg, time in self._kept() if from_stamp <= time <= to_stamp]

    def getElemAfterTime(self, stamp: Time) -> Any:  # noqa: N802 - its name there
        """Return the first message at or after a time, or None."""
        return next((msg for msg, time in self._kept() if time >= stamp), None)

    def getElemBeforeTime(self, stamp: Time) -> Any:  # noqa: N802 - its name there
        """Return the last message at or before a time, or None."""
        return next((msg for msg, time in reversed(self._kept()) if time <= stamp), None)

    def getLastestTime(self) -> Time | None:  # noqa: N802 - its name there
        """Return the time of the last message, or None."""
        return self.cache_times[-1] if self.cache_times else None

    getLatestTime = getLastestTime  # noqa: N815 - its name there

    def getOldestTime(self) -> Time | None:  # noqa: N802 - its name there
        """Return the time of the oldest message kept, or None."""
        return self.cache_times[0] if self.cache_times else None

    def getLast(self) -> Any:  # noqa: N802 - its name there
        """Return the last message, or None."""
        latest = self.getLastestTime()
        return None if latest is None else self.getElemAfterTime(latest)

    def _kept(self) -> list[tuple[object, Time]]:
        return list(zip(self.cache_msgs, self.cache_times, strict=True))


class TimeSynchronizer(SimpleFilter):
    """Passes on sets of messages, one from each filter, with equal stamps.

    Args:
        fs: The filters.
        queue_size: The number of messages of each filter that wait for the others.
    """

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int) -> None:
        super().__init__()
        self.queue_size, self.lock = queue_size, threading.Lock()
        frame = users_frame(sys._getframe(1))
        self._graphflow_place = f"{short_place(frame.f_code.co_filename, frame.f_lineno)}: " if frame else ""
        self._graphflow_unheard = 0
        self._graphflow_unmatched: Unmatched | None = None
        """The watch over the stamps, until a first set is complete or the lack of one is reported."""
        self.connectInput(fs)
        self._graphflow_watch(fs, slop_ns=0)

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:  # noqa: N802 - its name there
        """Connect filters as the inputs."""
        self.queues: list[dict[int, object]] = [{} for _ in fs]
        pairs = enumerate(zip(fs, self.queues, strict=True))
        self.input_connections = [_connected(f, self, self.add, queue, index) for index, (f, queue) in pairs]

    def add(self, msg: Any, my_queue: dict[int, object], my_queue_index: int | None = None) -> None:
        """Take a message from a filter."""
        with self.lock:
            stamp_ns = Time.from_msg(msg.header.stamp).nanoseconds
            self._keep(stamp_ns, msg, my_queue)
            common = sorted(set[int].intersection(*(set(queue) for queue in self.queues)))
            found = [[queue.pop(stamp) for queue in self.queues] for stamp in common]
            if self._graphflow_unmatched is not None:
                self._graphflow_take(my_queue_index, stamp_ns, is_complete=bool(found))
        for together in found:
            self.signalMessage(*together)

    def signalMessage(self, *msg: object) -> None:  # noqa: N802 - its name there
        super().signalMessage(*msg)
        if not self.callbacks:
            self._graphflow_unheard += 1
            if self._graphflow_unheard == UNHEARD:
                text = "%sthis synchronizer has matched messages, but has no callback; write %s"
                logger.warning(text, self._graphflow_place, "synchronizer.registerCallback(self.callback)")

    def _graphflow_watch(self, fs: Sequence[SimpleFilter], slop_ns: int) -> None:
        names = [getattr(f, "topic_name", type(f).__name__) for f in fs]
        if len(names) > 1:
            kind = type(self).__name__
            self._graphflow_unmatched = Unmatched(kind, self._graphflow_place, names, self.queue_size, slop_ns)

    def _graphflow_take(self, index: int | None, stamp_ns: int, *, is_complete: bool) -> None:
        watch = self._graphflow_unmatched
        if is_complete or index is None or (watch is not None and watch.take(index, stamp_ns)):
            self._graphflow_unmatched = None

    def _keep(self, stamp_ns: int, msg: object, queue: dict[int, object]) -> None:
        queue[stamp_ns] = msg
        while len(queue) > self.queue_size:
            del queue[min(queue)]


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Passes on sets of messages, one from each filter, with approximately equal stamps.

    Args:
        fs: The filters.
        queue_size: The number of messages of each filter that wait for the others.
        slop: The greatest difference between the stamps of a set, in seconds.
        allow_headerless: Whether to accept messages without a header as well, by time of arrival.
    """

    def __init__(
        self, fs: Sequence[SimpleFilter], queue_size: int, slop: float, allow_headerless: bool = False
    ) -> None:
        super().__init__(fs, queue_size)
        self.slop, self.allow_headerless = Duration(seconds=slop), allow_headerless
        self._graphflow_watch(fs, self.slop.nanoseconds)

    def add(self, msg: Any, my_queue: dict[int, object], my_queue_index: int | None = None) -> None:
        """Take a message from a filter."""
        stamp = _stamp(msg, self.allow_headerless, "message_filters_approx")
        if stamp is None:
            return
        with self.lock:
            self._keep(stamp.nanoseconds, msg, my_queue)
            stamps = self._nearest(stamp.nanoseconds, my_queue)
            together = [queue.pop(at) for queue, at in zip(self.queues, stamps, strict=True)] if stamps else []
            if self._graphflow_unmatched is not None:
                self._graphflow_take(my_queue_index, stamp.nanoseconds, is_complete=bool(together))
        if together:
            self.signalMessage(*together)

    def _nearest(self, stamp_ns: int, mine: dict[int, object]) -> Sequence[int]:
        """Return the stamps nearest to a new message's, one per filter, nearest first; empty if one is missing."""
        slop_ns = self.slop.nanoseconds
        if stamp_ns not in mine:  # older than all that are kept
            return ()
        choices: list[Iterable[int]] = []
        for queue in self.queues:
            # `<=` for one filter and `<` for the set, as in message_filters.
            near = [stamp_ns] if queue is mine else [at for at in queue if abs(at - stamp_ns) <= slop_ns]
            choices.append(sorted(near, key=lambda at: abs(at - stamp_ns)))
        return next((stamps for stamps in product(*choices) if max(stamps) - min(stamps) < slop_ns), ())


_logger = cache(get_logger)
"""Cached loggers: each throttles its own warnings."""


def _stamp(msg: Any, allow_headerless: bool, logger: str) -> Time | None:
    """Return a message's stamp; None, with a warning, if it has none."""
    stamp = getattr(getattr(msg, "header", None), "stamp", None)
    if stamp is not None:
        return stamp if hasattr(stamp, "nanoseconds") else Time.from_msg(stamp)
    if allow_headerless:
        return ROSClock().now()
    _logger(logger).warn(
        "a message without a stamp is dropped; allow_headerless=True uses its time of arrival",
        throttle_duration_sec=10.0,
    )
    return None
