"""Which callbacks may run at the same time."""

from __future__ import annotations

import threading
from typing import Any
from weakref import WeakSet


class CallbackGroup:
    """Decides when the callbacks of its entities may run. Not for use itself: derive from it."""

    def __init__(self) -> None:
        super().__init__()
        self.entities: WeakSet[Any] = WeakSet()

    def add_entity(self, entity: Any) -> None:
        """Add a timer, subscription or the like."""
        self.entities.add(entity)

    def has_entity(self, entity: Any) -> bool:
        """Whether an entity was added."""
        return entity in self.entities

    def can_execute(self, entity: Any) -> bool:
        """Whether an entity's callback may run now."""
        raise NotImplementedError

    def beginning_execution(self, entity: Any) -> bool:
        """Take what the callback needs; False if it must not run after all."""
        raise NotImplementedError

    def ending_execution(self, entity: Any) -> None:
        """Give back what the callback had."""
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """All callbacks may run at the same time."""

    def can_execute(self, entity: Any) -> bool:
        return True

    def beginning_execution(self, entity: Any) -> bool:
        return True

    def ending_execution(self, entity: Any) -> None:
        """Nothing was taken."""


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """One callback runs at a time, and until it has ended: also while it awaits something."""

    def __init__(self) -> None:
        super().__init__()
        self._active_entity: Any = None
        self._lock = threading.Lock()

    def can_execute(self, entity: Any) -> bool:
        with self._lock:
            return self._active_entity is None

    def beginning_execution(self, entity: Any) -> bool:
        with self._lock:
            if self._active_entity is None:
                self._active_entity = entity
                return True
        return False

    def ending_execution(self, entity: Any) -> None:
        with self._lock:
            if self._active_entity is entity:
                self._active_entity = None
