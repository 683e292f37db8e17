"""What waits to be sent to a viewer."""

from __future__ import annotations

import pytest

from graphflow.viewer import client


def test_a_viewer_that_does_not_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """Loses the oldest messages, and then its connection; nothing grows for ever."""
    monkeypatch.setattr(client, "DATA_BOUND", 1000)
    monkeypatch.setattr(client, "WORDS_BOUND", 5)
    slow = client.Client(None)  # type: ignore[arg-type]
    for number in range(100):
        slow.show(b"head", bytes([number]) * 96)
    assert (slow.dropped, len(slow._data)) == (90, 10)
    assert slow._data[0][4] == 90
    slow.show(b"head", bytes(5000))
    assert len(slow._data) == 1
