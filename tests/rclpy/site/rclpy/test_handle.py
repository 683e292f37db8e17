"""Handles."""

from __future__ import annotations

import pytest

from graphflow.errors import ClosedError
from rclpy._rclpy_pybind11 import RCLError
from rclpy.exceptions import InvalidHandle
from rclpy.handle import Handle, sending


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


def test_what_is_sent_after_the_end_is_an_error_of_rcls() -> None:
    """As rclpy's own, for those who expect it."""
    with pytest.raises(RCLError, match="shut down: closed"), Handle(lambda: None):
        raise ClosedError("closed")
    with pytest.raises(RCLError, match="shut down: closed"), sending():
        raise ClosedError("closed")
