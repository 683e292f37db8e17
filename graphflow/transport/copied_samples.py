"""Samples copied out of the buffers that Zenoh received them in, for queues in which they may stay long."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import zenoh

from graphflow.transport.inbox import Inbox

COPIED_BELOW = 64 << 10
"""Size in bytes below which a message is copied out of the buffer it shares with others; Zenoh's are as large."""


class _Bytes(bytes):
    """An attachment copied out of Zenoh's memory."""

    def to_bytes(self) -> bytes:
        return self


class _Copied:
    """A sample copied out of Zenoh's memory."""

    __slots__ = ("_data", "attachment")

    def __init__(self, data: bytes, beside: Any) -> None:
        self._data = data
        self.attachment = None if beside is None else _Bytes(beside.to_bytes())

    @property
    def payload(self) -> _Copied:
        return self

    def __len__(self) -> int:
        return len(self._data)

    def to_bytes(self) -> bytes:
        return self._data


def copying(inbox: Inbox) -> Callable[[zenoh.Sample], None]:
    """Return a callback that queues copies: a small sample would keep the whole buffer alive that it arrived in."""

    def put(sample: zenoh.Sample) -> None:
        payload = sample.payload
        is_small = len(payload) < COPIED_BELOW
        inbox.put(_Copied(payload.to_bytes(), sample.attachment) if is_small else sample)

    return put
