"""The admission rules of one concurrency group: slots, tickets and a fair queue.

A *member* is anything whose runs the group counts: a subscription, a timer, a service, an action. It takes a slot
before each run and returns it afterwards. While the group is full it has one ticket, in first-come order, however much
work it has. A returned slot passes straight to the head of the queue, so that nothing can take it in between. With
n members that queue again after each run, one that has work runs after at most n - 1 other runs.

Source: docs/architecture.md, "The rules of groups": slots, tickets, hand-over. rclpy's MutuallyExclusiveCallbackGroup
is a limit of 1.
"""

from __future__ import annotations

from collections import deque
from typing import Generic, TypeVar

from graphflow.interface import WhenFull

M = TypeVar("M")


class GroupState(Generic[M]):
    """The state of one group.

    Args:
        limit: Runs at one time; None for any number.
        name: The name for reports.
        when_full: Policy of the members for work that finds no free slot; the group itself only issues tickets.
    """

    __slots__ = ("_queue", "limit", "members", "name", "running", "when_full")

    def __init__(self, limit: int | None = 1, name: str = "", when_full: WhenFull = "wait") -> None:
        self.limit = limit
        self.name = name
        self.when_full = when_full
        self.running = 0
        """Slots taken."""
        self.members: list[M] = []
        """Members in the order in which they joined."""
        self._queue: deque[M] = deque()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name or 'unnamed'} {self.running}/{self.limit} taken>"

    @property
    def waiting(self) -> tuple[M, ...]:
        """Members with a ticket, in the order in which they will be served."""
        return tuple(self._queue)

    def admit(self, member: M) -> bool:
        """Take a slot for `member`, or a ticket if none is free. No member gets a second ticket."""
        if not self._queue and (self.limit is None or self.running < self.limit):
            self.running += 1
            return True
        if member not in self._queue:
            self._queue.append(member)
        return False

    def release(self) -> M | None:
        """Return a slot; the result is the member that it passes to, which holds it from now on, or None."""
        # Not if the limit was lowered meanwhile: then the slot is gone.
        if self._queue and (self.limit is None or self.running <= self.limit):
            return self._queue.popleft()
        self.running -= 1
        return None

    def grant(self) -> M | None:
        """Pass a free slot to the head of the queue, as after the limit was raised; None if there is neither."""
        if self._queue and (self.limit is None or self.running < self.limit):
            self.running += 1
            return self._queue.popleft()
        return None

    def withdraw(self, member: M) -> None:
        """Drop the ticket of a member that no longer wants to run."""
        if member in self._queue:
            self._queue.remove(member)
