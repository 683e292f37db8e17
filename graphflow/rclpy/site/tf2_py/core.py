"""The transform buffer with messages as its interface."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import lru_cache
from typing import Any

from geometry_msgs.msg import TransformStamped

from graphflow.errors import TransformError
from graphflow.tf.faults import fault_of
from graphflow.tf.frames import Frames
from graphflow.tf.poses import Pose
from graphflow.tf.transform import fill, pose_of
from rclpy.duration import Duration
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.impl.watches.unknown_frames import UnknownFrames
from rclpy.logging import get_logger
from rclpy.time import Time
from tf2_py.exceptions import InvalidArgumentException, TransformException, in_words_of_tf2

DEFAULT_AUTHORITY = "default_authority"
"""The name that tf2 gives an unknown sender."""


def nanoseconds(time: Any) -> int:
    """Convert an rclpy time, or a message's, to nanoseconds."""
    return time.nanoseconds if isinstance(time, Time) else time.sec * 10**9 + time.nanosec


def message(pose: Pose, target: str, source: str, stamp: int) -> TransformStamped:
    """Convert the pose of a frame to a message of rclpy's class."""
    out = TransformStamped()
    fill(out, pose, target, source, stamp)
    return out


@lru_cache(100)
def _logger(about: str) -> RcutilsLogger:
    """Return the logger for one kind of warning; cached, since it throttles its lines."""
    return get_logger("tf2")


class BufferCore:
    """A buffer of transforms between frames over time. Thread-safe.

    Args:
        cache_time: The duration for which they are kept; 10 seconds by default.
    """

    def __init__(self, cache_time: Duration | None = None) -> None:
        kept = 10 * 10**9 if cache_time is None else cache_time.nanoseconds
        self._graphflow_frames = Frames(kept)
        self._graphflow_authorities: dict[str, str] = {}
        self._graphflow_lock = threading.Lock()
        self._graphflow_unknown = UnknownFrames()

    def set_transform(self, transform: TransformStamped, authority: str = DEFAULT_AUTHORITY) -> None:
        """Add a transform; an invalid one is dropped and logged."""
        self._graphflow_put(transform, authority, is_static=False)

    def set_transform_static(self, transform: TransformStamped, authority: str = DEFAULT_AUTHORITY) -> None:
        """Add a transform that holds for all times."""
        self._graphflow_put(transform, authority, is_static=True)

    def _graphflow_put(self, transform: TransformStamped, authority: str, *, is_static: bool) -> None:
        # tf2 strips the slash of tf1's names from what it receives, and refuses it in lookups.
        parent, frame = transform.header.frame_id.lstrip("/"), transform.child_frame_id.lstrip("/")
        pose = pose_of(transform.transform)
        fault = fault_of(frame, parent, pose)
        if fault is not None:
            _logger(fault).error(f"transform from {authority!r} is dropped: {fault}", throttle_duration_sec=1.0)
            return
        with self._graphflow_lock:
            stamp = nanoseconds(transform.header.stamp)
            is_kept = self._graphflow_frames.put(frame, parent, stamp, pose, is_static=is_static)
            if is_kept:
                self._graphflow_authorities[frame] = authority
        if not is_kept:
            sender = "" if authority == DEFAULT_AUTHORITY else f" from {authority!r}"
            text = f"transform of {frame!r}{sender} is dropped: it is too old, or the buffer is full"
            way = "if a simulation began again, set use_sim_time, or restart this node"
            _logger(frame).warning(f"{text}; {way}", throttle_duration_sec=1.0)

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: object) -> TransformStamped:
        """Return the transform that takes coordinates in `source_frame` to those in `target_frame`.

        Args:
            time: 0 for the latest.

        Raises:
            TransformException: There is none; the subclass gives the reason.
        """
        if target_frame != source_frame:
            _check(target_frame, "target_frame")
            _check(source_frame, "source_frame")
        pose, stamp = self._graphflow_find(target_frame, source_frame, nanoseconds(time))
        return message(pose, target_frame, source_frame, stamp)

    def _graphflow_find(self, target: str, source: str, stamp: int) -> tuple[Pose, int]:
        """Return the pose of `source` in `target`, and its time. Raises TransformException."""
        try:
            with self._graphflow_lock:
                found = self._graphflow_frames.find(target, source, stamp)
        except TransformError as error:
            if self._graphflow_frames.histories:  # an empty buffer has another cause, which is reported elsewhere
                self._graphflow_unknown.lookup_failed(error)
            raise in_words_of_tf2(error) from None
        if stamp:
            self._graphflow_unknown.lookup_succeeded()
        return found

    def lookup_transform_full_core(
        self, target_frame: str, target_time: object, source_frame: str, source_time: object, fixed_frame: str
    ) -> TransformStamped:
        """Return the transform between two times; `fixed_frame` does not move between them."""
        for name, role in ((target_frame, "target"), (source_frame, "source"), (fixed_frame, "fixed")):
            _check(name, f"{role}_frame")
        first, _ = self._graphflow_find(fixed_frame, source_frame, nanoseconds(source_time))
        second, stamp = self._graphflow_find(target_frame, fixed_frame, nanoseconds(target_time))
        return message(second.of(first), target_frame, source_frame, stamp)

    def can_transform_core(self, target_frame: str, source_frame: str, time: object) -> tuple[bool, str]:
        """Whether a transform is available, and the reason if not."""
        return _can(lambda: self.lookup_transform_core(target_frame, source_frame, time))

    def can_transform_full_core(
        self, target_frame: str, target_time: object, source_frame: str, source_time: object, fixed_frame: str
    ) -> tuple[bool, str]:
        """Whether a transform between two times is available, and the reason if not."""
        return _can(
            lambda: self.lookup_transform_full_core(target_frame, target_time, source_frame, source_time, fixed_frame)
        )

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Return the latest time at which the whole chain between two frames is known. Raises TransformException."""
        try:
            with self._graphflow_lock:
                return Time(nanoseconds=self._graphflow_frames.latest_common(target_frame, source_frame))
        except TransformError as error:
            raise in_words_of_tf2(error) from None

    def clear(self) -> None:
        """Forget all transforms but the static ones."""
        with self._graphflow_lock:
            self._graphflow_frames.clear()

    def all_frames_as_string(self) -> str:
        """Return a line for each frame that has a parent."""
        with self._graphflow_lock:
            known = [(f, h.parents[-1]) for f, h in sorted(self._graphflow_frames.histories.items())]
        return "".join(f"Frame {frame} exists with parent {parent}.\n" for frame, parent in known)

    def all_frames_as_yaml(self) -> str:
        """Return, for each frame with a parent: the parent, the publisher, the rate and the time span."""
        with self._graphflow_lock:
            known = sorted(self._graphflow_frames.histories.items())
            lines = []
            for frame, history in known:
                span = (history.stamps[-1] - history.stamps[0]) / 1e9
                # tf2 divides by 0.1 ms at least, so that one sample has this rate.
                rate = 10000.0 if span <= 0 else (len(history.stamps) - 1) / span
                lines += [f"{frame}: ", f"  parent: '{history.parents[-1]}'"]
                lines += [f"  broadcaster: '{self._graphflow_authorities.get(frame, '')}'", f"  rate: {rate:.3f}"]
                lines += [f"  most_recent_transform: {history.stamps[-1] / 1e9:.6f}"]
                lines += [f"  oldest_transform: {history.stamps[0] / 1e9:.6f}", f"  buffer_length: {span:.3f}"]
        return "".join(f"{line}\n" for line in lines) or "{}"

    def _frameExists(self, frame_id: str) -> bool:  # noqa: N802 - tf2's name
        """Whether a frame is known."""
        with self._graphflow_lock:
            return self._graphflow_frames.has(frame_id)

    def _getFrameStrings(self) -> list[str]:  # noqa: N802 - tf2's name
        """Return all known frames."""
        with self._graphflow_lock:
            return self._graphflow_frames.names()


def _can(look_up: Callable[[], object]) -> tuple[bool, str]:
    try:
        look_up()
    except TransformException as error:
        return False, str(error)
    return True, ""


def _check(frame: str, role: str) -> None:
    said = f'Invalid argument "{frame}" passed to lookupTransform argument {role}'
    if frame.startswith("/"):
        raise InvalidArgumentException(f"{said} in tf2 frame_ids cannot start with a '/'")
    if not frame:
        raise InvalidArgumentException(f"{said} in tf2 frame_ids cannot be empty")
