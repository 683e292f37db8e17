"""Copies of samples, which do not keep Zenoh's buffers alive."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow.transport.copied_samples import COPIED_BELOW, copying
from graphflow.transport.inbox import Bell, Inbox


class Part:
    """Zenoh's bytes."""

    def __init__(self, data: bytes) -> None:
        self.data = data

    def __len__(self) -> int:
        return len(self.data)

    def to_bytes(self) -> bytes:
        return self.data


class Sample:
    def __init__(self, payload: bytes, attachment: bytes | None) -> None:
        self.payload = Part(payload)
        self.attachment = None if attachment is None else Part(attachment)


@pytest.mark.parametrize("attachment", [b"beside", None])
@pytest.mark.parametrize(("size", "is_copied"), [(COPIED_BELOW - 1, True), (COPIED_BELOW, False)])
async def test_small_samples_are_copied(
    graphflow_runner: asyncio.Runner, size: int, is_copied: bool, attachment: bytes | None
) -> None:
    """A large one fills its buffer and is queued as it is; both read alike."""
    bell = Bell(asyncio.get_running_loop(), threads=False)
    inbox = Inbox(bell, None, lambda: None)
    sample: Any = Sample(bytes(size), attachment)
    copying(inbox)(sample)
    [queued] = inbox.items
    bell.close()
    assert (queued is not sample) == is_copied
    assert (len(queued.payload), queued.payload.to_bytes()) == (size, bytes(size))
    assert (queued.attachment and queued.attachment.to_bytes()) == attachment
