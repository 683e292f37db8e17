"""Intra-process delivery: messages between nodes of one process, without CDR and without the network.

A publisher passes messages directly to its own process's subscriptions on the same key, and to others over the network.
Pairs of TRANSIENT_LOCAL endpoints use the network, which keeps the messages for late subscriptions.
"""

from __future__ import annotations

from collections.abc import Callable, Sized
from typing import Any, Protocol

from graphflow.qos import Durability, Qos


class Handed:
    """A message in transit to subscriptions of the same process.

    Args:
        message: A private copy.
        fields: The attachment's fields: sequence number, time in nanoseconds, GID.
        receivers: The number of subscriptions.
    """

    __slots__ = ("_clone", "_left", "_message", "fields")

    def __init__(
        self, message: Any, fields: tuple[int, int, bytes], receivers: int, clone: Callable[[Any], Any]
    ) -> None:
        self._message, self._left, self._clone = message, receivers, clone
        self.fields = fields

    @property
    def payload(self) -> Sized:
        """An object with the approximate size of the payload: the longest field of the unencoded message."""
        fields = (_sized(getattr(self._message, field.name)) for field in self._message.SCHEMA.fields)
        return max(fields, key=len, default=b"")

    def take(self) -> Any:
        """Return the message for one receiver, which may modify it: a copy, or the original for the last receiver."""
        self._left -= 1
        return self._message if not self._left else self._clone(self._message)


def _sized(value: Any) -> Sized:
    if getattr(value, "nbytes", 0):  # the length of a multi-dimensional array is that of its first dimension
        return memoryview(value).cast("B")
    return value if isinstance(value, Sized) else b""


class Receiver(Protocol):
    """A subscription, as publishers of its process see it."""

    qos: Qos

    def hand(self, handed: Handed) -> None: ...


class IntraProcess:
    """The subscriptions of a process with intra-process delivery, by key. One per `Context`."""

    def __init__(self) -> None:
        self._receivers: dict[str, list[Receiver]] = {}
        self._lists: dict[tuple[str, Durability], list[Receiver]] = {}

    def join(self, key: str, receiver: Receiver) -> None:
        self._receivers.setdefault(key, []).append(receiver)
        self._update(key)

    def leave(self, key: str, receiver: Receiver) -> None:
        if receiver in self._receivers.get(key, ()):
            self._receivers[key].remove(receiver)
            self._update(key)

    def receivers(self, key: str, durability: Durability) -> list[Receiver]:
        """Return the receivers for a publisher, as a list that is kept up to date."""
        if (key, durability) not in self._lists:
            self._lists[key, durability] = []
            self._update(key)
        return self._lists[key, durability]

    def _update(self, key: str) -> None:
        there = self._receivers.get(key, [])
        for durability in Durability:
            listed = self._lists.get((key, durability))
            if listed is not None:
                listed[:] = [r for r in there if Durability.VOLATILE in (durability, r.qos.durability)]
