"""Publishers: encode and send messages, by way of the network, shared memory or intra-process delivery."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from threading import get_ident
from time import sleep
from typing import Any, Generic, NoReturn, TypeVar
from weakref import WeakSet

from graphflow.errors import ClosedError, EncodeError, Place
from graphflow.executor.runner import Runner
from graphflow.msgs import registry
from graphflow.msgs.base import Message
from graphflow.msgs.instead import in_its_message
from graphflow.names import did_you_mean
from graphflow.qos import DEFAULT, INFINITE_NS, Liveliness, Qos
from graphflow.runtime.endpoints.endpoint import Endpoint
from graphflow.runtime.endpoints.events import OnEvent, SilenceTimer
from graphflow.runtime.endpoints.intra_process import Handed, Receiver
from graphflow.runtime.part import Host
from graphflow.transport.base import LargeSender, Payload, Sender
from graphflow.wire import attachment
from graphflow.wire.liveliness import Entity, Kind
from graphflow.wire.shared_memory import ring_key

M = TypeVar("M", bound=Message)
_pack = attachment.LAYOUT.pack

WITH_CONTRADICTIONS = {
    *("geometry_msgs/msg/Pose", "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseWithCovarianceStamped"),
    *("nav_msgs/msg/OccupancyGrid", "nav_msgs/msg/Odometry", "nav_msgs/msg/Path"),
    *("sensor_msgs/msg/BatteryState", "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/Image"),
    *("sensor_msgs/msg/JointState", "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/NavSatFix"),
    *("sensor_msgs/msg/PointCloud2", "trajectory_msgs/msg/JointTrajectory"),
    *("visualization_msgs/msg/Marker", "visualization_msgs/msg/MarkerArray"),
}
"""The types whose first messages are checked; here, so that publishers of others need not import the checks."""


_open: WeakSet[TopicPublisher[Any]] = WeakSet()
"""The open publishers of this process."""


def _refuse_in_child() -> None:
    for publisher in list(_open):
        publisher.refuse()


if sys.platform != "win32":
    os.register_at_fork(after_in_child=_refuse_in_child)


class _Order:
    """Sends messages in the order of their sequence numbers, whichever thread publishes them.

    A lock costs as much as encoding a small message. So the first thread that publishes does without it until another
    thread publishes, too.
    """

    __slots__ = ("is_sending", "is_shared", "lock", "number", "thread")

    def __init__(self) -> None:
        self.number = 0
        """The last sequence number."""
        self.lock = threading.RLock()
        self.thread = 0
        """The id of the first thread that has published."""
        self.is_shared = False
        """Whether other threads have published."""
        self.is_sending = False
        """Whether the first thread is sending a message without the lock."""

    def look_who_publishes(self) -> None:
        """Switch to the lock, in a thread that may not be the first, before it publishes."""
        if self.is_shared:
            return
        with self.lock:
            if not self.thread:
                self.thread = get_ident()
                return
            self.is_shared = True
            while self.is_sending:  # from its next message on, the first thread takes the lock
                sleep(0)


class TopicPublisher(Endpoint, Generic[M]):
    """A publisher."""

    kind = Kind.PUBLISHER
    unheard = 0
    """Messages published while there was no subscription."""

    def __init__(self, host: Host, type_: type[M], name: str, qos: Qos, on_event: OnEvent | None = None) -> None:
        super().__init__(host, type_.SCHEMA.name, name, qos, on_event)
        self.type = type_
        self._order = _Order()
        self._codec = registry.codec(self.type_name)
        self._sender: Sender = _NOT_OPEN
        self._put: Callable[..., None] = _NOT_OPEN.put
        self._large: LargeSender | None = None
        """The sender that replaces the sender's `put` for types whose messages may be large."""
        self._gid = bytes(16)
        self._now_ns: Callable[[], int] = int
        self._deadline: SilenceTimer | None = None
        self._lease: SilenceTimer | None = None
        self._alive: Sender | None = None
        self._here: Sequence[Receiver] = ()
        """The subscriptions of this process with intra-process delivery."""
        self._unfollow: Callable[[], None] = _nothing
        self._is_checked = False
        """Whether the messages that its first subscription has missed are checked."""
        self._paused: tuple[Sender, Sequence[Receiver]] | None = None
        """The sender and receivers of a paused publisher; None while it is not paused."""

    @property
    def published(self) -> int:
        """Messages sent since the start, which is also the last sequence number."""
        return self._order.number

    def _open(self, key: str) -> None:
        session = self.host.context.session
        self._gid, self._now_ns = self._announced().gid, self.host.context.clock.time_ns
        self._sender = session.open_sender(key, self.qos, only_others=True)
        self._declared.append(self._sender)
        self._put = self._sender.put
        if registry.has_number_lists(self.type_name):
            self._share_memory(key)
        self._here = self.host.context.intra_process.receivers(key, self.qos.durability)
        if self.qos.deadline_ns != INFINITE_NS:
            self._deadline = self._silence_timer(self.qos.deadline_ns, lambda: self._tell("deadline_missed"))
        if self.qos.liveliness is Liveliness.MANUAL_BY_TOPIC and self.qos.lease_ns != INFINITE_NS:
            self._lease = self._silence_timer(self.qos.lease_ns, lambda: self._tell("liveliness_lost"))
            self._alive = session.open_sender(alive_key(self._announced()), DEFAULT)
            self._declared.append(self._alive)
        self._shorten()
        _open.add(self)
        if self.type_name in WITH_CONTRADICTIONS:
            self._check_first()

    def _check_first(self) -> None:
        """Check the first messages for contradictions, in a `publish` that gives way to the usual one after them."""
        from graphflow.runtime.mistakes.contradictions import FirstMessages  # most processes never need it

        first, usual = FirstMessages(self.host, self.type_name, self.name), self.publish

        def publish(message: M) -> None:
            first.check(message)
            if not first.is_open and self.__dict__.get("publish") is publish:
                self._lengthen()
                self._shorten()
            usual(message)

        vars(self)["publish"] = publish

    def _shorten(self) -> None:
        """Install a fast `publish` for the usual case.

        That is: the first thread, a message of the right type, and subscriptions only in other processes.
        """
        if self._large is not None or self._deadline is not None or self._lease is not None:
            return
        general, type_, codec, order = self.publish, self.type, self._codec, self._order
        sender, here, put, now_ns, gid = self._sender, self._here, self._put, self._now_ns, self._gid

        def publish(message: M) -> None:
            if here or message.__class__ is not type_ or get_ident() != order.thread or not sender.is_wanted:
                general(message)
                return
            payload = codec.encode(message)
            # Before `is_shared` is read, the reverse of `look_who_publishes`: one of two threads sees the other.
            order.is_sending = True
            try:
                if order.is_shared:
                    # Cleared first: a thread that holds the lock may be waiting for that.
                    order.is_sending = False
                    with order.lock:
                        self._send(payload)
                else:
                    order.number += 1
                    put(payload, attachment=_pack(order.number, now_ns(), 16, gid))
            except Exception as error:  # any, since the node may stop on another thread: see `_not_sent`
                raise self._not_sent(error) from None
            finally:
                order.is_sending = False

        self.publish = publish  # type: ignore[method-assign]

    def refuse(self) -> None:
        """Raise an error at each message, in a child process, in which no thread of the session runs."""

        def publish(_: object) -> NoReturn:
            text = f"{self.name}: nothing is published in a child process, which has no connection"
            raise ClosedError(f"{text}; run the work with await self.offload(work), or return its results by a Queue")

        vars(self)["publish"] = vars(self)["put"] = publish

    def _lengthen(self) -> None:
        """Restore the general `publish`."""
        self.__dict__.pop("publish", None)

    def _share_memory(self, key: str) -> None:
        context = self.host.context
        self._large = context.session.open_large_sender(self._sender, ring_key(context.domain, key))
        if self._large is not None:
            self._declared.append(self._large)
            self._put = self._large.put_parts
            self._unfollow = context.readers.follow(self._look_for_readers)

    def _look_for_readers(self) -> None:
        if self._large is not None and self.entity is not None:
            own = self.entity.zid
            others = [entity for entity in self.matched.values() if entity.zid != own]
            self._large.admit(self.host.context.readers.of(others))

    def _matched(self, other: Entity, alive: bool) -> None:
        self._look_for_readers()
        if alive and 0 < self.unheard == self.published and not self._is_checked:
            from graphflow.runtime.mistakes.network.unkept import check_later  # most processes never need it

            self._is_checked = check_later(self, other, self.host.context.clock, self.host.log)

    def single_sends(self) -> Sequence[Place]:
        """Return the lines at which its node publishes; empty if one may run twice, or that is unknown."""
        return self.host.single_sends(self)

    def _silence_timer(self, period_ns: int, silent: Callable[[], None]) -> SilenceTimer:
        timer = SilenceTimer(self.host.clock, period_ns, silent)
        timer.start()
        return timer

    @property
    def is_wanted(self) -> bool:
        """Whether a message published now would reach a subscription or be kept; check before building a large one."""
        return self._sender.is_wanted or bool(self._here)

    def publish(self, message: M) -> None:
        """Send a message, from any thread. Never waits: a slow subscriber loses messages.

        Raises:
            EncodeError: A field does not fit its type, or the message is of another type. Of the messages without
                subscriptions, only the first is checked.
            ClosedError: The node is not running.
        """
        if message.__class__ is not self.type:
            made = f"; write {self.type.__name__}(...)"
            hint = made if isinstance(message, type) else in_its_message(self.type, message)
            raise EncodeError(f"{self.name} carries {self.type_name}, not {message!r}{hint}")
        sender = self._sender
        if self._here:
            self._hand_over(message, sender)
        elif sender.is_wanted:
            codec = self._codec
            payload: Any = codec.encode(message) if self._large is None else codec.encode_parts(message)
            order = self._order
            if get_ident() != order.thread:
                order.look_who_publishes()
            order.is_sending = True
            try:
                if order.is_shared:
                    order.is_sending = False
                    with order.lock:
                        self._send(payload)
                else:
                    self._order.number += 1
                    self._put(payload, attachment=_pack(self.published, self._now_ns(), 16, self._gid))
            except Exception as error:  # any, since the node may stop on another thread: see `_not_sent`
                raise self._not_sent(error) from None
            finally:
                order.is_sending = False
        elif self._paused is not None:
            self._complain(f"what is published on {self.name} is not sent: {self.idle_because}")
            return
        else:
            if self.entity is None:
                self._announced()  # raises the error
            if not self.unheard:
                self._check_fields(message)
            self._order.number += 1
            self.unheard += 1
        if self._deadline is not None:
            self._deadline.touch()
        if self._lease is not None:
            self._lease.touch()

    def _check_fields(self, message: M) -> None:
        """Encode a message only to check its fields, so that a wrong type is found before there are subscriptions."""
        encode: Callable[[M], object] = self._codec.encode if self._large is None else self._codec.encode_parts
        encode(message)

    def _send(self, payload: Any) -> None:
        self._order.number += 1
        self._put(payload, attachment=_pack(self.published, self._now_ns(), 16, self._gid))

    def _hand_over(self, message: M, sender: Sender) -> None:
        """Give a copy to the subscriptions of this process, and send the message if others want it."""
        clone, receivers = self._codec.clone, tuple(self._here)  # a copy, since another thread may change it
        copy = clone(message)
        encode: Callable[[M], Any] = self._codec.encode if self._large is None else self._codec.encode_parts
        payload = encode(copy) if sender.is_wanted else None
        if get_ident() != self._order.thread:
            self._order.look_who_publishes()
        with self._order.lock:
            self._order.number += 1
            fields = (self.published, self._now_ns(), self._gid)
            handed = Handed(copy, fields, len(receivers), clone)
            for receiver in receivers:
                receiver.hand(handed)
            if payload is not None:
                try:
                    self._put(payload, attachment=attachment.pack(*fields))
                except Exception as error:  # any, since the node may stop on another thread: see `_not_sent`
                    raise self._not_sent(error) from None

    @contextmanager
    def loan(self, **lengths: int) -> Iterator[M]:
        """Fill a message in place and publish it at the end of the block: `with pub.loan(data=1000) as image:`.

        The longest of its arrays is in shared memory, if possible, where subscriptions of other processes read it
        without a copy. Write into it (`image.data[:] = ...`) rather than replace it; after the block it is read-only.
        A block that raises publishes nothing. One loan at a time uses shared memory; others are ordinary messages.

        Args:
            lengths: Number of elements of its arrays of numbers, by field.

        Raises:
            EncodeError: The message has no such array of numbers.
            ClosedError: The node is not running.
        """
        self._announced()
        message, longest = self.type(), None
        for name, count in lengths.items():
            setattr(message, name, self._array(name, count))
            if longest is None or getattr(message, name).nbytes > getattr(message, longest).nbytes:
                longest = name
        large, lent = self._large, None
        if large is not None and longest is not None:
            array = getattr(message, longest)
            with self._order.lock:
                lent = large.lend(array.dtype, array.size)
            if lent is not None:
                setattr(message, longest, lent)
        try:
            yield message
            self.publish(message)
        finally:
            if large is not None and lent is not None:
                with self._order.lock:
                    large.take_back()

    def _array(self, name: str, count: int) -> Any:
        from graphflow.wire.cdr.arrays import DTYPES, zeros

        field = next((f for f in self.type.SCHEMA.fields if f.name == name), None)
        if field is None or field.type.array not in ("unbounded", "bounded") or field.type.base not in DTYPES:
            arrays = [f.name for f in self.type.SCHEMA.fields if f.type.array and f.type.base in DTYPES]
            raise EncodeError(f"{self.type_name} has no array of numbers {name!r} to lend{did_you_mean(name, arrays)}")
        return zeros(field.type.base, count)

    def _not_sent(self, error: Exception) -> Exception:
        """Convert the transport's error, which is expected if another thread stops the node."""
        return error if self.host.is_running else ClosedError(f"{self.name}: node {self.host.full_name} has ended")

    def assert_liveliness(self) -> None:
        """Assert liveliness without publishing, for MANUAL_BY_TOPIC liveliness.

        Raises:
            ClosedError: The node is not running.
        """
        self._announced()
        if self._lease is not None and self._alive is not None:
            self._lease.touch()
            self._alive.put(b"", attachment=b"")

    def clock_changed(self) -> None:
        for timer in (self._deadline, self._lease):
            if timer is not None:
                timer.move(self.host.clock)

    def statistics(self) -> dict[str, Any]:
        """Return counters of messages; for types with arrays, also those of messages sent by shared memory."""
        large = self._large
        shared = {} if large is None else {"in_memory": large.in_memory, "memory": large.memory}
        return {"published": self.published, **shared, **super().statistics()}

    def get_subscription_count(self) -> int:
        """Return the number of matched subscriptions."""
        self._announced()
        return len(self.matched)

    def pause(self, why: str) -> Runner | None:
        """Discard published messages until `resume`."""
        self._lengthen()
        if self._paused is None:
            self._paused = (self._sender, self._here)
            self._sender, self._here = _NOT_OPEN, ()
        return super().pause(why)

    def resume(self) -> Runner | None:
        if self._paused is not None:
            (self._sender, self._here), self._paused = self._paused, None
            self._shorten()
        return super().resume()

    def close(self) -> None:
        self._lengthen()
        for timer in (self._deadline, self._lease):
            if timer is not None:
                timer.stop()
        self._sender, self._here, self._paused = _NOT_OPEN, (), None
        self._unfollow()
        _open.discard(self)
        super().close()


class _NotOpen:
    """The sender of a publisher that is not on the network."""

    is_wanted = False

    def put(self, payload: Payload, *, attachment: bytes) -> None:
        """Discard the payload."""

    def close(self) -> None:
        """Do nothing: there are no resources."""


_NOT_OPEN = _NotOpen()


def _nothing() -> None:
    """Do nothing: no readers are tracked."""


def alive_key(publisher: Entity) -> str:
    """Return the key of a publisher's manual liveliness assertions. rmw_zenoh has no equivalent."""
    return f"@graphflow/{publisher.domain}/alive/{publisher.gid.hex()}"
