"""The poses of frames in their parents over time, and the chains between frames."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass, field

from graphflow.errors import ExtrapolationError, FrameLoop, TransformError, UnconnectedFrames, UnknownFrame
from graphflow.names import nearest
from graphflow.tf.poses import IDENTITY, Pose

FRAMES_BOUND = 10_000
"""The number of frames and parents kept, at most; more come from a mistake, or an attack."""
SAMPLES_BOUND = 20_000
"""The number of poses kept per frame, at most, whatever their times."""
TOTAL_BOUND = 1_000_000
"""The number of poses kept in total, at most."""
BACK = 10**9
"""A jump of a node's time into the past, in nanoseconds, by which a simulation, or a bag, has begun again."""
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

    @property
    def rate(self) -> float:
        """Poses per second; 0 for fewer than two."""
        span = self.stamps[-1] - self.stamps[0]
        return (len(self.stamps) - 1) * 1e9 / span if span > 0 else 0.0

    def put(self, stamp: int, pose: Pose, parent: str, kept: int) -> bool:
        """Add a pose and drop those more than `kept` nanoseconds older than the latest; return False if too old."""
        stamps = self.stamps
        if self.is_static:
            self.stamps, self.poses, self.parents = [stamp], [pose], [parent]
            return True
        if not stamps or stamp > stamps[-1]:  # nearly always
            stamps.append(stamp)
            self.poses.append(pose)
            self.parents.append(parent)
        elif stamp < stamps[-1] - kept:
            return False
        else:
            at = bisect_left(stamps, stamp)
            place = slice(at, at + (stamps[at] == stamp))
            stamps[place], self.poses[place], self.parents[place] = [stamp], [pose], [parent]
        if stamps[0] < stamps[-1] - kept or len(stamps) > SAMPLES_BOUND:
            gone = max(bisect_left(stamps, stamps[-1] - kept), len(stamps) - SAMPLES_BOUND)
            del stamps[:gone], self.poses[:gone], self.parents[:gone]
        return True

    def at(self, stamp: int) -> tuple[Pose, str] | None:
        """Return the pose and parent at a time, 0 for the latest; None before the first and after the last."""
        stamps = self.stamps
        if self.is_static or stamp == 0 or stamp == stamps[-1]:
            return self.poses[-1], self.parents[-1]
        at = bisect_left(stamps, stamp)
        if at == len(stamps):
            return None
        if stamps[at] == stamp:
            return self.poses[at], self.parents[at]
        if at == 0:
            return None
        if self.parents[at - 1] != self.parents[at]:  # no pose is between two parents
            return self.poses[at - 1], self.parents[at - 1]
        before, after = stamps[at - 1], stamps[at]
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
        """Forget all frames but the static ones, as tf2 does: their publishers do not send them again."""
        self.histories = {frame: history for frame, history in self.histories.items() if history.is_static}
        self._parents = {parent for history in self.histories.values() for parent in history.parents}
        self._count = len(self.histories)

    def has(self, frame: str) -> bool:
        """Whether a frame is known, if only as a parent."""
        return frame in self.histories or frame in self._parents

    def names(self) -> list[str]:
        """Return the names of all frames."""
        return sorted({*self.histories, *self._parents})

    def parent(self, frame: str) -> str | None:
        """Return the current parent of a frame; None for a root, or an unknown frame."""
        history = self.histories.get(frame)
        return history.parents[-1] if history else None

    def ancestors(self, frame: str) -> list[str]:
        """Return a frame and those above it now, up to the root or the start of a loop."""
        return list(self._above(frame))

    def _above(self, frame: str) -> dict[str, None]:
        found, histories = {frame: None}, self.histories
        while (history := histories.get(frame)) is not None and (frame := history.parents[-1]) not in found:
            found[frame] = None
        return found

    def find(self, target: str, source: str, stamp: int) -> tuple[Pose, int]:
        """Return the pose of `source` in `target`, and its time.

        Args:
            stamp: Nanoseconds; 0 for the latest time common to the chain.

        Raises:
            UnknownFrame, UnconnectedFrames, FrameLoop, ExtrapolationError: There is none.
        """
        if target == source:  # a frame's place in itself needs no transform, not even a known frame
            return IDENTITY, stamp or (self.latest_common(target, source) if self.has(target) else 0)
        for frame in (target, source):
            if not self.has(frame):
                raise self._unknown(frame, target, source)
        stamp = stamp or self.latest_common(target, source)
        ups = {source: IDENTITY}
        missing = self._climb(source, stamp, ups, {target: IDENTITY}, (target, source))
        if target in ups:
            return ups[target], stamp
        downs = {target: IDENTITY}
        also_missing = self._climb(target, stamp, downs, ups, (target, source))
        common = next(reversed(downs))
        if common in ups:
            return downs[common].inverse().of(ups[common]), stamp
        raise missing or also_missing or self._unconnected(target, source)

    def chain(self, target: str, source: str) -> list[str]:
        """Return the frames from `target` to `source`, both included, through their nearest common ancestor.

        Raises:
            UnknownFrame, UnconnectedFrames, FrameLoop: They have none.
        """
        for frame in (target, source):
            if not self.has(frame):
                raise self._unknown(frame, target, source)
        down, common, up = self._meet(target, source)
        return [*down, common, *reversed(up)]

    def latest_common(self, target: str, source: str) -> int:
        """Return the latest time common to the chain between two frames; 0 if none of them moves.

        Raises:
            UnconnectedFrames, FrameLoop: The frames are not connected.
        """
        down, common, up = self._meet(target, source)
        stamps, histories = [], self.histories
        for frame in [*down, *up] or [common]:
            history = histories.get(frame)
            if history is not None and not history.is_static:
                stamps.append(history.stamps[-1])
        return min(stamps, default=0)

    def stopped(self, error: ExtrapolationError) -> str:
        """Describe another frame of a chain whose newest transform is of the requested time; "" if there is none."""
        for frame in self.chain(error.target, error.source):
            history = self.histories.get(frame)
            if history is not None and not history.is_static and history.stamps[-1] == error.requested_ns:
                how = "was sent once" if len(history.stamps) == 1 else "was last sent"
                text = f"; {history.parents[-1]} -> {frame} {how}, at that time: send it again"
                return f"{text}, or with send_static (StaticTransformBroadcaster) if it never changes"
        return ""

    def _meet(self, target: str, source: str) -> tuple[list[str], str, list[str]]:
        """Return the nearest common ancestor of two frames, and those below it on either side, from the bottom up."""
        ups, downs = self._above(source), self._above(target)
        for common in downs:
            if common in ups:
                down, up = list(downs), list(ups)
                return down[: down.index(common)], common, up[: up.index(common)]
        for start, above in ((source, ups), (target, downs)):
            top = next(reversed(above))
            if top in self.histories:
                raise self._loop(top, start, (target, source))
        raise self._unconnected(target, source)

    def _climb(
        self, frame: str, stamp: int, poses: dict[str, Pose], ends: dict[str, Pose], asked: tuple[str, str]
    ) -> TransformError | None:
        """Climb from a frame until one of `ends`, recording its poses; return the error if one is not known then."""
        pose, start, histories = IDENTITY, frame, self.histories
        while frame not in ends and (history := histories.get(frame)) is not None:
            found = history.at(stamp)
            if found is None:
                return self._extrapolation(frame, history, stamp, asked)
            step, frame = found
            if frame in poses:
                raise self._loop(frame, start, asked)
            pose = poses[frame] = step.of(pose) if pose is not IDENTITY else step
        return None

    def _unknown(self, frame: str, target: str, source: str) -> UnknownFrame:
        names = self.names()
        more = " ..." if len(names) > SHOWN else ""
        known = f"the known frames are {', '.join(names[:SHOWN])}{more}" if names else "no frame is known so far"
        near = nearest(frame, names)
        hint = f"; did you mean {near!r}?" if near else ""
        text = f"{target} -> {source}: there is no frame {frame!r}{hint}; {known}"
        return UnknownFrame(text, target, source, frame)

    def _unconnected(self, target: str, source: str) -> UnconnectedFrames:
        roots = [self.ancestors(frame)[-1] for frame in (target, source)]
        places = [
            f"{frame} is the root of a tree" if frame == root else f"{frame} is in the tree of {root}"
            for frame, root in zip((target, source), roots, strict=True)
        ]
        text = f"{target} -> {source}: {places[0]}, {places[1]}, and no transform connects the two"
        return UnconnectedFrames(text, target, source)

    def _loop(self, frame: str, start: str, asked: tuple[str, str]) -> FrameLoop:
        above = self.ancestors(frame)
        top = self.parent(above[-1]) or frame
        circle = [top, *reversed(above[above.index(top) :])][: 4 * SHOWN] if top in above else [start, top]
        text = f"{' -> '.join(asked)}: the frames form a loop: {' -> '.join(circle)}; let one of them have no parent"
        return FrameLoop(text, *asked, frame)

    @staticmethod
    def _extrapolation(frame: str, history: History, stamp: int, asked: tuple[str, str]) -> ExtrapolationError:
        oldest, newest, parent = history.stamps[0], history.stamps[-1], history.parents[-1]
        is_future = stamp > newest
        edge, distance = (
            (f"newest {parent} -> {frame}", stamp - newest)
            if is_future
            else (f"oldest {parent} -> {frame} kept", oldest - stamp)
        )
        relation = "older" if is_future else "newer"
        text = f"{' -> '.join(asked)} at {seconds(stamp)} s: the {edge} is {seconds(distance)} s {relation}"
        return ExtrapolationError(text, *asked, frame, parent, (stamp, oldest, newest))


def seconds(ns: int) -> str:
    """Return nanoseconds as seconds with two to nine decimals, as many as it takes to tell it from 0: `12.30`."""
    for places in range(2, 9):
        if ns == 0 or round(abs(ns) / 1e9, places):
            return f"{ns / 1e9:.{places}f}"
    return f"{ns / 1e9:.9f}"
