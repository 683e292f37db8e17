"""The error by which a program ends."""

from __future__ import annotations

import sys

import pytest

from rclpy.impl.failing import failure


def test_an_error_on_its_way_and_one_that_was_printed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The one that is being handled comes first."""
    monkeypatch.delattr(sys, "last_value", raising=False)
    assert failure() is None
    printed = ValueError("printed")
    monkeypatch.setattr(sys, "last_value", printed, raising=False)
    assert failure() is printed
    handled, found = KeyError("handled"), []
    try:
        raise handled
    except KeyError:
        found.append(failure())
    assert found == [handled]
