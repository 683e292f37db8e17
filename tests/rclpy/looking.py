"""Watches of a context that look when a test says so, by a clock that it advances."""

from __future__ import annotations

import rclpy


class ManualTime:
    """Stands in for the module `time` in a watch: it stands still until it is advanced."""

    def __init__(self) -> None:
        self.now = 100.0

    def monotonic(self) -> float:
        return self.now

    def advance(self, seconds: float) -> None:
        self.now += seconds


def look(times: int = 1) -> None:
    """Have the watches of the default context look, and wait until they have."""
    life = rclpy.get_default_context().life
    assert life is not None
    check = life.network().elsewhere[0].watches.check  # type: ignore[attr-defined]
    for _ in range(times):
        life.on_loop(check)
