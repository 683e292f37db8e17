"""The transforms of one node: received and kept, looked up and waited for, and sent."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from graphflow.errors import DeclarationError, ExtrapolationError, TransformError, UnknownFrame
from graphflow.executor.ledger import AwaitedTransform
from graphflow.msgs.geometry_msgs.msg import TransformStamped
from graphflow.msgs.std_msgs.msg import Header
from graphflow.msgs.tf2_msgs.msg import TFMessage
from graphflow.qos import Durability, Qos
from graphflow.runtime.declarations.creator import Creator, Owner
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.mistakes.rclpy_words import AttributeHints
from graphflow.tf.faults import fault_of
from graphflow.tf.frames import BACK, Frames, seconds
from graphflow.tf.info import FrameInfo, Sender
from graphflow.tf.reports import Reports
from graphflow.tf.transform import Stamp, Transform, pose_of, stamp_ns, stamped
from graphflow.times import NANOSECONDS, Time, to_ns
from graphflow.wire.attachment import MessageInfo

TOPIC, STATIC_TOPIC = "/tf", "/tf_static"
TYPE = "tf2_msgs/msg/TFMessage"
QOS = Qos(depth=100)
STATIC_QOS = Qos(depth=100, durability=Durability.TRANSIENT_LOCAL)
STATIC_SENDER_QOS = Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)
"""One message suffices for late subscribers, since each repeats all static transforms of its node."""
REPORTED_AFTER = 5.0
"""Seconds after which the log says what a lookup waits for."""
STOPPED_AFTER = 1.0
"""Seconds without a transform of a frame after which its publisher counts as stopped."""
TWO_CLOCKS = 10**6 * NANOSECONDS
"""A distance between two stamps that only two different clocks explain."""


@dataclass(slots=True, eq=False)
class _Wait:
    """A lookup that waits for transforms.

    Attributes:
        lacking: The frame that it lacks; "" for a connection between two trees.
    """

    find: Callable[[], Transform]
    future: asyncio.Future[Transform]
    lacking: str = ""


class TransformBuffer(AttributeHints):
    """The transforms that a node receives, and those that it sends. Declared by `Transforms`.

    Args:
        kept: Nanoseconds for which received transforms are kept.
        listen: Whether to receive transforms.
        attribute: The node's attribute with the buffer; "" if it has none.
    """

    def __init__(self, node: Creator, owner: Owner, kept: int, *, listen: bool, attribute: str = "") -> None:
        self._node, self._owner, self._listens = node, owner, listen
        owner.transforms.add(attribute)
        self._frames = Frames(kept)
        self._reports = Reports(owner.log)
        self._senders: dict[str, Sender] = {}
        self._waits: dict[str, dict[_Wait, None]] = {}
        """Lookups that wait, by what they lack."""
        self._latest_ns = 0
        """The node's time at the latest transform."""
        self._sent: dict[str, TransformStamped] = {}
        self._publisher: TopicPublisher[TFMessage] | None = None
        self._static_publisher: TopicPublisher[TFMessage] | None = None
        self._subscriptions: list[TopicSubscription[TFMessage]] = []
        if listen:
            self._subscribe(TOPIC, QOS, self._on_transforms)
            self._subscribe(STATIC_TOPIC, STATIC_QOS, self._on_static_transforms)

    def _subscribe(self, topic: str, qos: Qos, callback: Callable[[TFMessage, MessageInfo], None]) -> None:
        # In no group, and open before `on_start`: transforms arrive whatever the node's own handlers do.
        name, label = self._owner.names.resolve(topic), topic.lstrip("/")
        made = TopicSubscription(self._owner, TFMessage, name, qos, callback, label, takes_info=True)
        self._subscriptions.append(self._owner.add(made))

    def close(self) -> None:
        """Stop listening, and withdraw the publishers; for a buffer that does not live as long as its node."""
        parts: list[TopicSubscription[TFMessage] | TopicPublisher[TFMessage] | None]
        parts = [*self._subscriptions, self._publisher, self._static_publisher]
        for part in parts:
            if part is not None:
                part.close()

    def __repr__(self) -> str:
        return f"<transforms of {self._owner.full_name}, {len(self.frames)} frames>"

    # reading

    @property
    def frames(self) -> list[str]:
        """The names of all known frames, sorted."""
        return self._frames.names()

    def parent(self, frame: str) -> str | None:
        """Return the frame that a frame is placed in now; None for a root or an unknown frame."""
        return self._frames.parent(frame)

    def chain(self, target: str, source: str) -> list[str]:
        """Return the frames from `target` to `source`, both included, as they are placed now.

        Raises:
            UnknownFrame, UnconnectedFrames, FrameLoop: They are not connected.
        """
        return self._frames.chain(target, source)

    def info(self, frame: str) -> FrameInfo:
        """Return a frame's parent, publisher, rate and delays.

        Raises:
            UnknownFrame: No transform places it in another frame.
        """
        history, sender = self._frames.histories.get(frame), self._senders.get(frame)
        if history is None or sender is None:
            raise UnknownFrame(f"no transform places {frame!r} in another frame", frame, frame, frame)
        return FrameInfo(
            frame,
            history.parents[-1],
            self._name_of(sender.gid) or "",
            history.is_static,
            history.rate,
            Time(history.stamps[-1]),
            sender.delays_ns / sender.count / NANOSECONDS,
            sender.longest_ns / NANOSECONDS,
            (self._owner.clock.monotonic_ns() - sender.received_ns) / NANOSECONDS,
        )

    def infos(self) -> list[FrameInfo]:
        """Return the frames that have a parent, sorted by name."""
        return [self.info(frame) for frame in sorted(self._frames.histories) if frame in self._senders]

    def get(
        self, target: str, source: str, at: Stamp = None, *, fixed: str | None = None, target_at: Stamp = None
    ) -> Transform:
        """Return the pose of the frame `source` in `target`, from what is known now.

        Args:
            at: The time; None, or a stamp of 0, for the latest that the frames between the two have in common.
            fixed: A frame that did not move between `at` and `target_at`, for the pose of `source` at one time in
                `target` at another.
            target_at: The time of `target`, with `fixed`.

        Raises:
            UnknownFrame, UnconnectedFrames, FrameLoop, ExtrapolationError: It is not available; the text says what is
                missing, and who publishes that.
        """
        try:
            return self._find(target, source, at, fixed, target_at)
        except TransformError as error:
            error.args = (f"{error}{self._cause(error)}",)
            raise

    async def lookup(
        self,
        target: str,
        source: str,
        at: Stamp = None,
        *,
        timeout: float | None = 1.0,
        fixed: str | None = None,
        target_at: Stamp = None,
    ) -> Transform:
        """Wait for the pose of the frame `source` in `target`. Arguments as for `get`.

        Args:
            timeout: Seconds to wait, by the node's clock; None to wait without limit.

        Raises:
            TransformError: As for `get`, once the time is over.
            ClosedError: The node ends.
        """

        def find() -> Transform:
            return self._find(target, source, at, fixed, target_at)

        try:
            return find()
        except TransformError as error:
            lacking = error.frame
        context = self._owner.context
        wait = _Wait(find, context.loop.create_future())
        self._add(wait, lacking)
        due_ns = context.clock.monotonic_ns() + to_ns(REPORTED_AFTER)
        late = context.clock.call_at(due_ns, partial(self._report_wait, find))
        try:
            with context.ledger.transform(wait.future, partial(self._awaited, target, source, wait)):
                if timeout is None:
                    return await wait.future
                async with self._owner.clock.timeout(timeout):
                    return await wait.future
        except TimeoutError:
            try:
                return find()
            except TransformError as error:
                error.args = (f"{error}{self._cause(error)} (waited {timeout:g} s)",)
                raise error from None
        finally:
            late.cancel()
            self._remove(wait)

    def _awaited(self, target: str, source: str, wait: _Wait) -> AwaitedTransform:
        """Describe a lookup that waits, for the search for deadlocks."""
        what = f"the transform {target} -> {source}"
        if sender := self._senders.get(wait.lacking):
            return AwaitedTransform(what, node=self._name_of(sender.gid) or "")
        unknown = tuple(frame for frame in (target, source) if not self._frames.has(frame))
        return AwaitedTransform(what, unknown or (target, source))

    def _report_wait(self, find: Callable[[], Transform]) -> None:
        """Log what a lookup that lasts lacks."""
        try:
            find()
        except TransformError as error:
            text = f"{error}{self._cause(error)}"
            self._owner.log.warning("a lookup waits for %g s so far: %s", REPORTED_AFTER, text)

    async def transform(
        self,
        message: Any,
        to: str,
        *,
        timeout: float | None = 1.0,
        fixed: str | None = None,
        at: Stamp = None,
    ) -> Any:
        """Return a message with a header in another frame, at the time of its stamp; a scan becomes a `PointCloud2`.

        Args:
            to: The frame.
            timeout: Seconds to wait for the transform.
            fixed, at: A frame that did not move between the message's time and `at`, the time for which it is wanted.

        Raises:
            TypeError: Messages of its type cannot be converted.
            TransformError: Its header has no frame, or as for `lookup`.
        """
        try:
            header: Header = message.header
        except AttributeError:
            text = f"a {type(message).__name__} has no header, so that its frame is not known; use lookup()"
            raise TypeError(text) from None
        if not header.frame_id:
            text = f"the {type(message).__name__} does not say in which frame it is: set its header.frame_id"
            raise TransformError(text, to, "")
        found = await self.lookup(to, header.frame_id, header.stamp, timeout=timeout, fixed=fixed, target_at=at)
        return found.apply(message)

    def _find(self, target: str, source: str, at: Stamp, fixed: str | None, target_at: Stamp) -> Transform:
        if not self._listens:
            text = "does not listen to transforms: declare Transforms() without listen=False"
            raise DeclarationError(f"{self._owner.full_name} {text}")
        if fixed is None:
            pose, stamp = self._frames.find(target, source, stamp_ns(at))
        else:
            first, _ = self._frames.find(fixed, source, stamp_ns(at))
            second, stamp = self._frames.find(target, fixed, stamp_ns(target_at))
            pose = second.of(first)
        return Transform(target, source, pose, Time(stamp))

    def _cause(self, error: TransformError) -> str:
        """Say who publishes what is missing, as the end of the error's text."""
        if isinstance(error, ExtrapolationError):
            return self._of_publisher(error)
        if isinstance(error, UnknownFrame) and not self._frames.names():
            senders = {e.node_name for s in self._subscriptions for e in s.matched.values()} - {self._owner.full_name}
            return self._reports.nothing_known(senders, [one.name for one in self._subscriptions])
        return ""

    def _of_publisher(self, error: ExtrapolationError) -> str:
        """Describe the publisher of a frame: `; /odometry publishes it at 30 Hz, and stopped 4.00 s ago`."""
        sender = self._senders.get(error.frame)
        if sender is None:
            return ""
        distance = max(error.requested_ns - error.newest_ns, error.oldest_ns - error.requested_ns)
        if distance > TWO_CLOCKS:
            return "; one of the two times is simulated: set use_sim_time on both nodes, or on neither"
        if error.requested_ns < error.oldest_ns:
            return self._frames.stopped(error) or self._too_old(error)
        history = self._frames.histories[error.frame]
        rate = f" at {history.rate:.3g} Hz" if history.rate else ""
        silent = self._owner.clock.monotonic_ns() - sender.received_ns
        period = to_ns(1 / history.rate) if history.rate else 0
        name = self._name_of(sender.gid)
        if name is None:
            return "; the node that published it has ended"
        stopped = f", and stopped {seconds(silent)} s ago" if silent > max(to_ns(STOPPED_AFTER), 3 * period) else ""
        return f"; {name} publishes it{rate}{stopped}"

    def _too_old(self, error: ExtrapolationError) -> str:
        """Say why an earlier transform is not there: it has never come, or is no longer kept."""
        kept = self._frames.kept
        if error.newest_ns - error.oldest_ns < kept // 2:
            return "; none from before has come since this node listens: ask for a later time"
        return f"; the node keeps {seconds(kept)} s, more with Transforms(cache=...)"

    def _name_of(self, gid: bytes) -> str | None:
        """Return the full name of the node with a publisher; None if there is none."""
        for subscription in self._subscriptions:
            for publisher in subscription.matched.values():
                if publisher.gid == gid:
                    return publisher.node_name
        return None

    # receiving

    def _on_transforms(self, message: TFMessage, info: MessageInfo) -> None:
        self._put(message, info.gid, is_static=False)

    def _on_static_transforms(self, message: TFMessage, info: MessageInfo) -> None:
        self._put(message, info.gid, is_static=True)

    def _put(self, message: TFMessage, gid: bytes, *, is_static: bool) -> None:
        clock = self._owner.clock
        now, time_ns = clock.monotonic_ns(), clock.time_ns()
        if time_ns < self._latest_ns - BACK:
            back = seconds(self._latest_ns - time_ns)
            self._owner.log.info("the time has jumped back by %s s; only static transforms are kept", back)
            self._frames.clear()
        self._latest_ns = time_ns
        for transform in message.transforms:
            header, frame = transform.header, transform.child_frame_id
            parent, pose = header.frame_id, pose_of(transform.transform)
            if frame[:1] == "/" or parent[:1] == "/":
                self._reports.slash(self._sender(gid), frame if frame[:1] == "/" else parent)
                frame, parent = frame.lstrip("/"), parent.lstrip("/")
            if fault := fault_of(frame, parent, pose):
                self._reports.dropped(self._sender(gid), fault)
                continue
            stamp = header.stamp.sec * NANOSECONDS + header.stamp.nanosec
            before = self._frames.parent(frame)
            if not self._frames.put(frame, parent, stamp, pose, is_static=is_static):
                self._reports.late(self._sender(gid), frame)
                continue
            sender = self._senders.get(frame)
            if sender is None or sender.gid != gid or before != parent:
                self._sender_changed(frame, parent, before, sender, gid)
                sender = self._senders[frame]
            sender.received_ns = now
            sender.count += 1
            delay = time_ns - stamp
            sender.delays_ns += delay
            if delay > sender.longest_ns:
                sender.longest_ns = delay
            if self._waits:
                self._wake(frame)
                if before != parent:  # it may have made a frame known, or joined two trees
                    self._wake(parent)
                    self._wake("")

    def _sender_changed(self, frame: str, parent: str, before: str | None, sender: Sender | None, gid: bytes) -> None:
        """Note the first transform of a frame, or one with another publisher or parent than the one before."""
        if before != parent:
            above = self._frames.ancestors(parent)
            if frame in above:
                circle = " -> ".join([*reversed(above[: above.index(frame) + 1][:20]), frame])
                self._reports.loop(frame, circle, self._sender(gid))
            elif before is not None and sender is not None:
                places = (before, self._sender(sender.gid)), (parent, self._sender(gid))
                self._reports.two_parents(frame, *places)
        elif sender is not None and sender.parent == parent and (gid, parent) in sender.former:
            self._reports.two_senders(frame, parent, *sorted([self._sender(sender.gid), self._sender(gid)]))
        former = frozenset() if sender is None else frozenset({*sender.former, (sender.gid, sender.parent)})
        self._senders[frame] = Sender(gid, parent, former if len(former) < 10 else frozenset())

    def _sender(self, gid: bytes) -> str:
        return self._name_of(gid) or "a node that has ended"

    def _add(self, wait: _Wait, lacking: str) -> None:
        wait.lacking = lacking
        self._waits.setdefault(lacking, {})[wait] = None

    def _remove(self, wait: _Wait) -> None:
        alike = self._waits.get(wait.lacking, {})
        alike.pop(wait, None)
        if not alike:
            self._waits.pop(wait.lacking, None)

    def _wake(self, lacking: str) -> None:
        """Try the lookups again that lack a frame, or a connection."""
        for wait in list(self._waits.get(lacking, ())):
            self._remove(wait)
            try:
                found = wait.find()
            except TransformError as error:
                self._add(wait, error.frame)
            else:
                if not wait.future.done():
                    wait.future.set_result(found)

    # sending

    def send(self, *transforms: Transform | TransformStamped) -> None:
        """Publish transforms on /tf; those without a time get the present one.

        Raises:
            TransformError: A transform has a fault, such as a rotation that is not of length 1.
        """
        if self._publisher is None:
            self._publisher = self._create(TOPIC, QOS)
        self._publisher.publish(TFMessage(transforms=[self._checked(one) for one in transforms]))

    def _create(self, topic: str, qos: Qos) -> TopicPublisher[TFMessage]:
        made = self._node.create_publisher(TFMessage, topic, qos)
        assert isinstance(made, TopicPublisher)
        return made

    def send_static(self, *transforms: Transform | TransformStamped) -> None:
        """Publish transforms on /tf_static: they hold for all times, and late subscribers receive them, too.

        Raises:
            TransformError: As for `send`.
        """
        if self._static_publisher is None:
            self._static_publisher = self._create(STATIC_TOPIC, STATIC_SENDER_QOS)
        checked = [self._checked(one) for one in transforms]
        for one in checked:
            before = self._sent.get(one.child_frame_id)
            if before is not None and pose_of(before.transform) != pose_of(one.transform):
                self._reports.moving(one.header.frame_id, one.child_frame_id)
        self._sent |= {one.child_frame_id: one for one in checked}
        self._static_publisher.publish(TFMessage(transforms=list(self._sent.values())))

    def _checked(self, transform: Transform | TransformStamped) -> TransformStamped:
        one = transform if isinstance(transform, TransformStamped) else transform.to_msg()
        frame, parent = one.child_frame_id, one.header.frame_id
        fault = fault_of(frame, parent, pose_of(one.transform))
        if fault is None and "/" in (frame[:1], parent[:1]):
            fault = f"the name of a frame has no slash in front: write {frame.lstrip('/')!r} in {parent.lstrip('/')!r}"
        if fault is not None:
            raise TransformError(f"the transform {parent} -> {frame} is not sent: {fault}", parent, frame)
        if not (one.header.stamp.sec or one.header.stamp.nanosec):
            one = stamped(pose_of(one.transform), parent, frame, self._owner.clock.time_ns())
        return one
