"""Callback groups: which callbacks may run at the same time."""

from __future__ import annotations

import threading
from weakref import WeakSet


class CallbackGroup:
    """The base class of callback groups, which decide when their entities' callbacks may run."""

    def __init__(self) -> None:
        super().__init__()
        self.entities: WeakSet[object] = WeakSet()

    def add_entity(self, entity: object) -> None:
        """Add an entity, such as a timer or subscription."""
        self.entities.add(entity)

    def has_entity(self, entity: object) -> bool:
        """Whether an entity was added."""
        return entity in self.entities

    def can_execute(self, entity: object) -> bool:
        """Whether an entity's callback may run now."""
        raise NotImplementedError

    def beginning_execution(self, entity: object) -> bool:
        """Reserve a place for the callback; return False if it must not run after all."""
        raise NotImplementedError

    def ending_execution(self, entity: object) -> None:
        """Release the callback's place."""
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """A group without limits: all callbacks may run at the same time."""

    def can_execute(self, entity: object) -> bool:
        return True

    def beginning_execution(self, entity: object) -> bool:
        return True

    def ending_execution(self, entity: object) -> None:
        """Do nothing: nothing was reserved."""


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """A group that runs one callback at a time, until it has ended: awaiting something does not release it."""

    def __init__(self) -> None:
        super().__init__()
        self._active_entity: object = None
        self._lock = threading.Lock()

    def can_execute(self, entity: object) -> bool:
        with self._lock:
            return self._active_entity is None

    def beginning_execution(self, entity: object) -> bool:
        with self._lock:
            if self._active_entity is None:
                self._active_entity = entity
                return True
        return False

    def ending_execution(self, entity: object) -> None:
        with self._lock:
            # rclpy asserts it; here `Spinning._begin` also releases what it may not have reserved.
            if self._active_entity is entity:
                self._active_entity = None
