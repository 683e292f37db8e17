"""Handles."""

from __future__ import annotations

import pytest

from rclpy.exceptions import InvalidHandle
from rclpy.handle import Handle


def test_it_is_of_use_until_it_was_destroyed() -> None:
    """Which withdraws what it is for, once."""
    told: list[int] = []
    handle = Handle(lambda: told.append(1), more=3)
    with handle as used:
        assert used.pointer == handle.pointer
        assert used.more == 3  # type: ignore[attr-defined]
    handle.destroy_when_not_in_use()
    handle.destroy_when_not_in_use()
    assert told == [1]
    assert handle.is_destroyed
    with pytest.raises(InvalidHandle), handle:
        pass
