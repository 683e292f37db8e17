"""The states of an action's goals as CDR, in which a change writes a single entry, however many goals there are.

An `action_msgs/msg/GoalStatusArray` is a list of entries: a goal's id (16 bytes); in all but the first, 3 bytes of
padding; the time at which it was accepted (int32 seconds, uint32 nanoseconds); its state (int8).
"""

from __future__ import annotations

import struct
from collections.abc import Iterable

from graphflow.errors import DecodeError
from graphflow.times import NANOSECONDS

_ENTRY = struct.Struct("<16s3xiIb")
_HEADER = b"\0\1\0\0"
_PADDING = slice(16, 19)
"""Padding before an entry's time, which the first entry does not have."""
_FIRST = 8
"""Offset of the first id: behind the header and the number of entries."""
_TRIES = 16
"""Largest number of searches for an id: finding it by chance at an offset that is no entry's is next to impossible."""
_OTHERS = _FIRST - 3
"""Offset of the other ids, modulo the size of an entry."""


class GoalStates:
    """The goals that an action server announces."""

    def __init__(self) -> None:
        self._ids: list[bytes] = []
        self._places: dict[bytes, int] = {}
        self._entries = bytearray()

    def add(self, goal_id: bytes, accepted_ns: int) -> None:
        """Add a goal, whose state is unknown at first.

        Args:
            accepted_ns: The time of day, nanoseconds since 1970.
        """
        self._places[goal_id] = len(self._ids)
        self._ids.append(goal_id)
        self._entries += _ENTRY.pack(goal_id, accepted_ns // NANOSECONDS, accepted_ns % NANOSECONDS, 0)

    def put(self, goal_id: bytes, state: int) -> None:
        """Change the state of a goal."""
        self._entries[(self._places[goal_id] + 1) * _ENTRY.size - 1] = state

    def remove(self, goal_id: bytes) -> None:
        """Remove a goal; the last one takes its place."""
        place, last = self._places.pop(goal_id), self._ids.pop()
        entry = self._entries[-_ENTRY.size :]
        del self._entries[-_ENTRY.size :]
        if last != goal_id:
            self._ids[place], self._places[last] = last, place
            self._entries[place * _ENTRY.size : (place + 1) * _ENTRY.size] = entry

    def to_bytes(self) -> bytes:
        """Encode the goals as a message."""
        entries = memoryview(self._entries)
        count = len(self._ids).to_bytes(4, "little")
        return b"".join((_HEADER, count, entries[: _PADDING.start], entries[_PADDING.stop :]))


def states_in(payload: bytes, goal_ids: Iterable[bytes]) -> dict[bytes, int]:
    """Read the states of goals from a message.

    Raises:
        DecodeError: It is no such message, or of another byte order.
    """
    count = int.from_bytes(payload[4:_FIRST], "little")
    size = _OTHERS + count * _ENTRY.size if count else _FIRST
    if payload[:2] != _HEADER[:2] or not size <= len(payload) < size + 4:
        raise DecodeError(f"action_msgs/msg/GoalStatusArray: {len(payload)} bytes for {count} goals")
    found = {}
    for goal_id in goal_ids:
        at = payload.find(goal_id, _FIRST, size)
        for _ in range(_TRIES):
            if at <= _FIRST or not (at - _OTHERS) % _ENTRY.size:
                break
            at = payload.find(goal_id, at + 1, size)  # a match across two entries
        else:
            at = -1
        if at >= 0:
            found[goal_id] = payload[_OTHERS + ((at - _OTHERS) // _ENTRY.size + 1) * _ENTRY.size - 1]
    return found
