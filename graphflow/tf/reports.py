"""Warnings about the transforms of others: one for each fault of each frame."""

from __future__ import annotations

import logging
from collections.abc import Collection, Iterable

MOVES = 3
"""Poses after the first with which a static frame counts as moving; a calibration may correct it once or twice."""
REPORTED_BOUND = 1000
"""The number of warnings that are remembered; further ones are not given."""


class Reports:
    """The warnings of one buffer."""

    def __init__(self, log: logging.Logger) -> None:
        self._log = log
        self._reported: set[tuple[str, str]] = set()
        self._moves: dict[str, int] = {}
        """The number of different poses of static frames that this node sends."""

    def _once(self, kind: str, frame: str, text: str, *args: object) -> None:
        if (kind, frame) not in self._reported and len(self._reported) < REPORTED_BOUND:
            self._reported.add((kind, frame))
            self._log.warning(text, *args)

    def dropped(self, sender: str, fault: str) -> None:
        """Warn of a transform with a fault."""
        self._once("fault", fault, "a transform of %s is dropped: %s", sender, fault)

    def nothing_known(self, senders: Collection[str], topics: Iterable[str]) -> str:
        """Say why no frame is known, as the end of an error's text."""
        faults = sorted(fault for kind, fault in self._reported if kind == "fault")
        if faults:
            return f"; all transforms so far were dropped: {faults[0]}"
        if not senders:
            return f"; no node publishes {' or '.join(topics)}"
        sends = "publishes transforms, and has sent none"
        if len(senders) > 1:
            sends = "publish transforms, and have sent none"
        text = f"; {', '.join(sorted(senders)[:3])} {sends} since this node listens"
        return f"{text}: a frame that never moves needs send_static (StaticTransformBroadcaster)"

    def slash(self, sender: str, frame: str) -> None:
        """Warn of a frame's name that begins with a slash."""
        text = "%s sends the frame %r: names of frames have no slash in front since ROS 2; it is read as %r"
        self._once("slash", frame, text, sender, frame, frame.lstrip("/"))

    def moving(self, parent: str, frame: str) -> None:
        """Warn of a frame that is sent as static and moves."""
        text = "%s -> %s is sent as static with another pose each time: for a frame that moves, write send(...)"
        self._moves[frame] = self._moves.get(frame, 0) + 1
        if self._moves[frame] == MOVES:
            self._once("moving", frame, text, parent, frame)

    def late(self, sender: str, frame: str) -> None:
        """Warn of a transform that is older than everything kept, or that finds no room."""
        text = "a transform of %r from %s is dropped: it is older than all that is kept, or the buffer is full; "
        text += "are the clocks of both machines, and use_sim_time of both nodes, the same?"
        self._once("late", frame, text, frame, sender)

    def two_senders(self, frame: str, parent: str, first: str, second: str) -> None:
        """Warn of a frame that two publishers place by turns."""
        text = "%s and %s both publish %s -> %s, and its place jumps between the two; stop one of them"
        self._once("senders", frame, text, first, second, parent, frame)

    def two_parents(self, frame: str, before: tuple[str, str], after: tuple[str, str]) -> None:
        """Warn of a frame that changes its parent; each parent comes with its publisher."""
        text = "%s is placed in %s by %s, and now in %s by %s: a frame has one parent; "
        text += "publish one of the two in the other direction, or rename a frame"
        self._once("parents", frame, text, frame, *before, *after)

    def loop(self, frame: str, circle: str, sender: str) -> None:
        """Warn of a transform that closes a loop."""
        text = "with a transform of %s the frames form a loop: %s; let one of them have no parent"
        self._once("loop", frame, text, sender, circle)
