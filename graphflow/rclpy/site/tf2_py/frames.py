"""The poses of frames in their parents over time, and the chains between frames."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass, field

from graphflow.names import did_you_mean
from tf2_py.exceptions import ConnectivityException, ExtrapolationException, LookupException, TransformException
from tf2_py.poses import IDENTITY, Pose

FRAMES_BOUND = 10_000
"""The number of frames and parents kept, at most; more come from a mistake, or an attack."""
SAMPLES_BOUND = 20_000
"""The number of poses kept per frame, at most, whatever their times."""
TOTAL_BOUND = 1_000_000
"""The number of poses kept in total, at most."""
SHOWN = 5
"""The number of frames that an error names."""


@dataclass(slots=True)
class History:
    """The poses of one frame, each in its parent at that time."""

    is_static: bool = False
    stamps: list[int] = field(default_factory=list)
    """Ascending, in nanoseconds."""
    poses: list[Pose] = field(default_factory=list)
    parents: list[str] = field(default_factory=list)

    def put(self, stamp: int, pose: Pose, parent: str, kept: int) -> bool:
        """Add a pose and drop those more than `kept` nanoseconds older than the latest; return False if too old."""
        if self.is_static:
            self.stamps, self.poses, self.parents = [stamp], [pose], [parent]
            return True
        if self.stamps and stamp < self.stamps[-1] - kept:
            return False
        at = bisect_left(self.stamps, stamp)
        is_known = at < len(self.stamps) and self.stamps[at] == stamp
        place = slice(at, at + is_known)
        self.stamps[place], self.poses[place], self.parents[place] = [stamp], [pose], [parent]
        gone = max(bisect_left(self.stamps, self.stamps[-1] - kept), len(self.stamps) - SAMPLES_BOUND)
        if gone > 0:
            del self.stamps[:gone], self.poses[:gone], self.parents[:gone]
        return True

    def at(self, stamp: int) -> tuple[Pose, str] | str:
        """Return the pose and parent at a time, 0 for the latest, or the reason why there is none."""
        if self.is_static or stamp == 0:
            return self.poses[-1], self.parents[-1]
        at = bisect_left(self.stamps, stamp)
        if at < len(self.stamps) and self.stamps[at] == stamp:
            return self.poses[at], self.parents[at]
        if len(self.stamps) == 1:
            known = f"but only time {_seconds(self.stamps[0])} is in the buffer"
            return f"at time {_seconds(stamp)}, {known}"
        if at == 0:
            return f"into the past.  Requested time {_seconds(stamp)} but the earliest data is at time " + _seconds(
                self.stamps[0]
            )
        if at == len(self.stamps):
            return f"into the future.  Requested time {_seconds(stamp)} but the latest data is at time " + _seconds(
                self.stamps[-1]
            )
        if self.parents[at - 1] != self.parents[at]:  # there is nothing between two parents
            return self.poses[at - 1], self.parents[at - 1]
        before, after = self.stamps[at - 1], self.stamps[at]
        return self.poses[at - 1].towards(self.poses[at], (stamp - before) / (after - before)), self.parents[at]


class Frames:
    """All known frames. Not thread-safe.

    Args:
        kept: The length of each frame's history in nanoseconds.
    """

    def __init__(self, kept: int) -> None:
        self.kept = kept
        self.histories: dict[str, History] = {}
        self.refused = 0
        """The number of poses dropped because they were too old, or too many."""
        self._count = 0
        self._parents: set[str] = set()

    def put(self, frame: str, parent: str, stamp: int, pose: Pose, *, is_static: bool) -> bool:
        """Add a frame's pose in its parent, in nanoseconds; return whether it was accepted."""
        history = self.histories.get(frame)
        is_full = len(self.histories) + len(self._parents) >= FRAMES_BOUND
        if (is_full and not (history and parent in self._parents)) or self._count >= TOTAL_BOUND:
            self.refused += 1
            return False
        before = len(history.stamps) if history else 0
        if history is None or history.is_static != is_static:
            history = self.histories[frame] = History(is_static)
        is_kept = history.put(stamp, pose, parent, self.kept)
        self._count += len(history.stamps) - before
        self.refused += not is_kept
        self._parents.add(parent)
        return is_kept

    def clear(self) -> None:
        """Forget all frames."""
        self.histories.clear()
        self._parents.clear()
        self._count = 0

    def has(self, frame: str) -> bool:
        """Whether a frame is known, if only as a parent."""
        return frame in self.histories or frame in self._parents

    def names(self) -> list[str]:
        """Return the names of all frames."""
        return sorted({*self.histories, *self._parents})

    def _unknown(self, frame: str, role: str) -> LookupException:
        """Return the error for an unknown frame, with the known ones."""
        error = LookupException(f'"{frame}" passed to lookupTransform argument {role} does not exist. ')
        names = self.names()
        known = f"the frames known so far are {', '.join(names[:SHOWN])}" if names else "no frame is known so far"
        error.add_note(
            f"note: {known}{' ...' if len(names) > SHOWN else ''}{did_you_mean(frame, names)}; "
            "frames take a while to arrive: catch tf2_ros.TransformException, and try again"
        )
        return error

    def find(self, target: str, source: str, stamp: int) -> tuple[Pose, int]:
        """Return the pose of `source` in `target`, and its time.

        Args:
            stamp: Nanoseconds; 0 for the latest time common to the chain.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException: There is none.
        """
        if target == source:  # where every frame is, also one that nobody has heard of
            return IDENTITY, stamp or (self.latest_common(target, source) if self.has(target) else 0)
        for frame, role in ((target, "target_frame"), (source, "source_frame")):
            if not self.has(frame):
                raise self._unknown(frame, role)
        if stamp == 0:
            stamp = self.latest_common(target, source)
        ups = {source: IDENTITY}
        fault = self._climb(source, stamp, ups, stop=target)
        if target in ups:
            return ups[target], stamp
        downs = {target: IDENTITY}
        other_fault = self._climb(target, stamp, downs, stop=ups)
        common = next((frame for frame in downs if frame in ups), None)
        if common is None:
            missing = fault or other_fault
            if missing is not None:
                way = f"when looking up transform from frame [{source}] to frame [{target}]"
                raise ExtrapolationException(f"Lookup would require extrapolation {missing}, {way}")
            raise self._unconnected(target, source)
        return downs[common].inverse().of(ups[common]), stamp

    def chain(self, frame: str) -> list[str]:
        """Return a frame and its current ancestors."""
        above: dict[str, Pose] = {frame: IDENTITY}
        self._climb(frame, 0, above, stop=())
        return list(above)

    def latest_common(self, target: str, source: str) -> int:
        """Return the latest time common to the chain between two frames; 0 if none of them moves.

        Raises:
            ConnectivityException: The frames are not connected.
        """
        ups, downs = self.chain(source), self.chain(target)
        common = next((frame for frame in ups if frame in downs), None)
        if common is None:
            raise self._unconnected(target, source)
        way = ups[: ups.index(common)] + downs[: downs.index(common)]
        moving = [self.histories[frame] for frame in way or [common] if frame in self.histories]
        return min((history.stamps[-1] for history in moving if not history.is_static), default=0)

    def _climb(
        self, frame: str, stamp: int, poses: dict[str, Pose], stop: str | tuple[()] | dict[str, Pose]
    ) -> str | None:
        """Climb from `frame` to the root, or to `stop`, recording its poses; return the reason if one is unknown."""
        pose, start = IDENTITY, frame
        ends = (stop,) if isinstance(stop, str) else stop
        while frame in self.histories and frame not in ends:
            found = self.histories[frame].at(stamp)
            if isinstance(found, str):
                return found
            step, frame = found
            if frame in poses:
                raise TransformException(
                    f"The tf tree is invalid because it contains a loop at [{frame}], above [{start}]"
                )
            pose = poses[frame] = step.of(pose)
        return None

    @staticmethod
    def _unconnected(target: str, source: str) -> ConnectivityException:
        return ConnectivityException(
            f"Could not find a connection between '{target}' and '{source}' because they are not part of the same "
            "tree. Tf has two or more unconnected trees."
        )


def _seconds(stamp: int) -> str:
    return f"{stamp // 10**9}.{stamp % 10**9 // 1000:06d}"
