"""The watches over a context's nodes that report silent failures other than deadlocks."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from rclpy.impl.mistakes.uncalled import Uncalled
from rclpy.impl.mistakes.unreached import Unreached
from rclpy.impl.mistakes.unused import Unused
from rclpy.impl.watches import orphans, unheard
from rclpy.impl.watches.late_timers import LateTimers
from rclpy.impl.watches.slow_readers import SlowReaders
from rclpy.impl.watches.starvation import HeldUp
from rclpy.impl.watches.unexecuted import Unexecuted
from rclpy.impl.watches.unserved import Unserved

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from graphflow.runtime.context import Context


class Watches:
    """The watches over one context's nodes.

    Args:
        is_reported: Whether a deadlock report covers a run, `"r"`, or a thread, `"t"`, by identity or by title.
    """

    def __init__(self, life: ContextState, context: Context, is_reported: Callable[..., bool]) -> None:
        self._held_up = HeldUp(life, is_reported)
        self.each = (
            self._held_up,
            LateTimers(life, self._held_up),
            SlowReaders(self._held_up),
            Unused(life),
            Unserved(life, context, is_reported),
            Unexecuted(life),
            Uncalled(life),
            Unreached(life),
        )
        unheard.attend(life)
        orphans.attend(life)

    def check(self) -> None:
        """Run all watches. Runs on the loop."""
        for watch in self.each:
            watch.check()

    @property
    def texts(self) -> list[str]:
        """Return the reports that still hold."""
        return self._held_up.texts
