"""Entities that follow the life cycle of a node."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any

from rclpy._rclpy_pybind11 import TransitionCallbackReturnType as TransitionCallbackReturn

if TYPE_CHECKING:
    from rclpy.lifecycle.node import LifecycleState


class ManagedEntity:
    """The base class of entities that are notified of their node's transitions."""

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS


class SimpleManagedEntity(ManagedEntity):
    """An entity that works only while its node is active."""

    def __init__(self) -> None:
        self._enabled = False

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._enabled = True
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._enabled = False
        return TransitionCallbackReturn.SUCCESS

    @property
    def is_activated(self) -> bool:
        return self._enabled

    @staticmethod
    def when_enabled(
        wrapped: Callable[..., object] | None = None, *, when_not_enabled: Callable[..., object] | None = None
    ) -> Callable[..., Any]:
        """Decorate a method to do nothing, or call `when_not_enabled`, while the node is not active."""

        def decorated(method: Callable[..., object]) -> Callable[..., object]:
            @wraps(method)
            def guarded(self: SimpleManagedEntity, *args: Any, **kwargs: object) -> Any:
                if self._enabled:
                    return method(self, *args, **kwargs)
                return None if when_not_enabled is None else when_not_enabled(self, *args, **kwargs)

            return guarded

        return decorated if wrapped is None else decorated(wrapped)
