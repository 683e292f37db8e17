"""Waitables: entities other than topics, services and timers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Self

from rclpy.callback_groups import CallbackGroup

if TYPE_CHECKING:
    from rclpy.task import Future


class NumberOfEntities:
    """The number of entries that a waitable needs in an rcl wait set."""

    __slots__ = (
        *("num_subscriptions", "num_guard_conditions", "num_timers", "num_clients", "num_services", "num_events"),
    )

    def __init__(
        self,
        num_subs: int = 0,
        num_gcs: int = 0,
        num_timers: int = 0,
        num_clients: int = 0,
        num_services: int = 0,
        num_events: int = 0,
    ) -> None:
        self.num_subscriptions, self.num_guard_conditions, self.num_timers = num_subs, num_gcs, num_timers
        self.num_clients, self.num_services, self.num_events = num_clients, num_services, num_events

    def __add__(self, other: NumberOfEntities) -> NumberOfEntities:
        total = NumberOfEntities()
        total += self
        total += other
        return total

    def __iadd__(self, other: NumberOfEntities) -> Self:
        for name in self.__slots__:
            setattr(self, name, getattr(self, name) + getattr(other, name))
        return self

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(str(getattr(self, name)) for name in self.__slots__)})"


class Waitable:
    """The base class of objects that become ready, have data to be taken, and execute with it.

    There are no rcl wait sets here: the executor calls `is_ready(None)` whenever it checks for work.
    """

    def __init__(self, callback_group: CallbackGroup) -> None:
        self.callback_group = callback_group
        self.callback_group.add_entity(self)
        self._futures: list[Future] = []

    def __enter__(self) -> None:
        """Do nothing."""

    def __exit__(self, *_: object) -> None:
        """Do nothing."""

    def add_future(self, future: Future) -> None:
        """Keep a future until it is done."""
        self._futures.append(future)

    def remove_future(self, future: Future) -> None:
        """Stop keeping a future."""
        self._futures.remove(future)

    def is_ready(self, wait_set: Any) -> bool:
        """Whether there is data to take."""
        raise NotImplementedError("Must be implemented by subclass")

    def take_data(self) -> Any:
        """Take the data."""
        raise NotImplementedError("Must be implemented by subclass")

    async def execute(self, taken_data: Any) -> None:
        """Execute with the taken data."""
        raise NotImplementedError("Must be implemented by subclass")

    def get_num_entities(self) -> NumberOfEntities:
        """Return the entries needed in a wait set."""
        raise NotImplementedError("Must be implemented by subclass")

    def add_to_wait_set(self, wait_set: Any) -> None:
        """Add to a wait set whatever becomes ready."""
        raise NotImplementedError("Must be implemented by subclass")

    # the executor's interface to entities

    def has_work(self) -> bool:
        return bool(self.is_ready(None))

    def take_work(self) -> Callable[[], object] | None:
        data = self.take_data()

        async def execute() -> None:
            await self.execute(data)

        return execute
