"""Waiting for what another thread, process or task brings about: with a limit, after which the test fails."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Any

LIMIT = 45.0
"""Seconds that anything may take before the test fails."""
PAUSE = 0.005
"""Seconds between two looks."""


def until(condition: Callable[[], Any], what: str | Callable[[], str] = "it came about", limit: float = LIMIT) -> Any:
    """Wait until a condition holds; returns its value.

    Args:
        what: The condition in words, or what else helps to understand a failure.
    """
    deadline = time.monotonic() + limit
    while not (value := condition()):
        _check(deadline, limit, what)
        time.sleep(PAUSE)
    return value


async def eventually(
    condition: Callable[[], Any], what: str | Callable[[], str] = "it came about", limit: float = LIMIT
) -> Any:
    """As `until`, while the event loop goes on."""
    deadline = time.monotonic() + limit
    while not (value := condition()):
        _check(deadline, limit, what)
        await asyncio.sleep(PAUSE)
    return value


def _check(deadline: float, limit: float, what: str | Callable[[], str]) -> None:
    if time.monotonic() > deadline:
        raise AssertionError(f"not within {limit} s: {what if isinstance(what, str) else what()}")
