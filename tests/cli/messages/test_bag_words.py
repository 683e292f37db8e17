"""Moments in a bag; tests/cli/ros/test_bag.py tests the order of words."""

from __future__ import annotations

from typing import Any

import click
import pytest

from graphflow.cli.messages.bag_words import moment_option


def test_a_moment_is_a_number() -> None:
    """A date is answered with the number that it is."""
    none: Any = None
    assert moment_option(none, none, "1.5") == 1.5
    assert moment_option(none, none, None) is None
    with pytest.raises(click.BadParameter, match=r"is not a number of seconds.*; as local time it is 1700000000$"):
        moment_option(none, none, "2023-11-14T22:13:20+00:00")


def test_a_moment_with_a_unit() -> None:
    """It is answered with its seconds."""
    none: Any = None
    with pytest.raises(click.BadParameter, match=r"^'2min' is not a number of seconds.*; write 120$"):
        moment_option(none, none, "2min")
