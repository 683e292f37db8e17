"""Guard conditions: callbacks that code triggers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rclpy.callback_groups import CallbackGroup
from rclpy.handle import Handle
from rclpy.impl.reexports import passed_on

if TYPE_CHECKING:
    from graphflow.rclpy.node_bridge import NodeBell
    from rclpy.context import Context


class GuardCondition:
    """Has an executor call `callback` after `trigger`; triggers that come meanwhile are merged."""

    def __init__(
        self,
        callback: Callable[[], object] | None,
        callback_group: CallbackGroup | None,
        context: Context | None = None,
        *,
        bell: NodeBell | None = None,
    ) -> None:
        self.callback, self.callback_group = callback, callback_group
        self._bell, self._is_triggered = bell, False
        self._handle = Handle(_nothing)

    @property
    def handle(self) -> Handle:
        return self._handle

    def trigger(self) -> None:
        """Schedule the callback. Callable from any thread."""
        with self._handle:
            self._is_triggered = True
            if self._bell is not None:
                self._bell.mark(self)

    def has_work(self) -> bool:
        return self._is_triggered and not self._handle.is_destroyed

    def take_work(self) -> Callable[[], object] | None:
        was_triggered, self._is_triggered = self._is_triggered, False
        return self.callback if was_triggered else None

    def destroy(self) -> None:
        """End the guard condition. Call `Node.destroy_guard_condition` instead."""
        self._handle.destroy_when_not_in_use()


def _nothing() -> None:
    """Do nothing."""


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)
