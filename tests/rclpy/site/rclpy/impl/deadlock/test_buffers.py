"""Waits until something is in a buffer, read from their frames."""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from tf2_ros import Buffer

from graphflow.analysis.frames import stack_from
from rclpy.duration import Duration
from rclpy.impl.deadlock.buffers import BufferWait, buffer_wait, know_buffer


class Store:
    """A buffer whose wait returns what is seen of it."""

    def look_up(self, target_frame: str, source_frame: str, timeout: Duration) -> BufferWait | None:
        return self.wait(timeout)

    def wait(self, timeout: Duration) -> BufferWait | None:
        return innermost_wait()


def innermost_wait() -> BufferWait | None:
    """What the code that calls this waits for."""
    caller, frame = stack_from(sys._getframe(1))[-2:]
    return buffer_wait(frame, caller)


def test_what_is_waited_for(tmp_path: Path) -> None:
    """With its limit, who brings it, and whether a file's code may too."""
    know_buffer(Store.wait, "fill")
    store: Any = Store()
    found = store.look_up("map", "base", Duration(seconds=2.5))

    assert found is not None
    assert (found.buffer, found.what, found.timeout) == (store, "the transform from base to map", 2.5)
    for buffer, is_it in ((store, True), (Store(), False)):
        assert found.is_filled_by(SimpleNamespace(callback=Listener(buffer).heard)) is is_it
    assert not found.is_filled_by(SimpleNamespace(callback=print))
    for i, (text, may) in enumerate([("store.fill(1)", True), ("store.other()", False), ("((", True)]):
        file = tmp_path / f"{i}.py"
        file.write_text(text, encoding="utf-8")
        assert found.may_be_filled_by([str(file)]) is may
    assert innermost_wait() is None


class Listener:
    """Fills a buffer."""

    def __init__(self, buffer: object) -> None:
        self.buffer = buffer

    def heard(self) -> None:
        """Put something in."""


def test_the_buffer_of_transforms_is_known() -> None:
    """Its methods are there under the names by which it is known."""
    waits: list[BufferWait] = []

    class Own(Buffer):
        def can_transform_core(self, *asked: Any) -> tuple[bool, str]:
            stack = stack_from(sys._getframe())
            [found] = [wait for pair in pairwise(stack) if (wait := buffer_wait(pair[1], pair[0])) is not None]
            waits.append(found)
            assert found.timeout == 0.0
            assert all(hasattr(self, name) for name in found.fillers)
            return True, ""

    assert Own().can_transform("map", "base", 0)
    assert waits
