"""Code that stands still at a line, for what reads frames: generators, a step at a time."""

from __future__ import annotations

from collections.abc import Iterator

from graphflow.analysis.frames import Frame, suspended


def after_a_step(steps: Iterator[object]) -> Frame:
    """The frame of a generator at its next `yield`."""
    next(steps)
    frame = suspended(steps)
    assert frame is not None
    return frame
