"""Who may run: slots, tickets and the queue of one concurrency group.

A *member* is anything whose runs the group counts: a subscription, a timer, a service. It asks for a slot before each
run and gives it back after. While the group is full it holds one ticket, in first-come order, however much work it
has; when a slot is given back it goes straight to the head of the queue, so that nobody can take it in between.
With n members of which each re-queues after a run, one that has work runs after at most n - 1 other runs.

Source: rules G3, G8, G9 of the concurrency design; rclpy's MutuallyExclusiveCallbackGroup is a limit of 1.
"""

from __future__ import annotations

from collections import deque
from typing import Generic, TypeVar

M = TypeVar("M")


class GroupState(Generic[M]):
    """The state of one group. Args: `limit`: runs at one time, None for any number."""

    __slots__ = ("_queue", "limit", "running")

    def __init__(self, limit: int | None = 1) -> None:
        self.limit = limit
        self.running = 0
        """Slots taken."""
        self._queue: deque[M] = deque()

    @property
    def waiting(self) -> tuple[M, ...]:
        """Members with a ticket, in the order they will be served."""
        return tuple(self._queue)

    def admit(self, member: M) -> bool:
        """Take a slot for `member`, or a ticket if there is none free. A second ticket is not given."""
        if not self._queue and (self.limit is None or self.running < self.limit):
            self.running += 1
            return True
        if member not in self._queue:
            self._queue.append(member)
        return False

    def release(self) -> M | None:
        """Give a slot back; returns the member it passes to, which holds it from now on, or None."""
        if self._queue and (self.limit is None or self.running <= self.limit):
            return self._queue.popleft()
        self.running -= 1
        return None

    def withdraw(self, member: M) -> None:
        """Drop the ticket of a member that no longer wants to run."""
        if member in self._queue:
            self._queue.remove(member)
