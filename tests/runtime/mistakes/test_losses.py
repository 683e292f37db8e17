"""Warnings about messages lost to a full queue."""

from __future__ import annotations

import logging
from typing import Any

import pytest

from graphflow.runtime.mistakes.losses import MANY_LOSSES, Losses


class _Host:
    log = logging.getLogger("graphflow.test")


@pytest.fixture
def losses(caplog: pytest.LogCaptureFixture) -> Losses:
    host: Any = _Host()
    return Losses(host, "/x", "heard")


@pytest.mark.parametrize(
    ("deep", "is_unread", "told"),
    [
        (None, True, "nothing has read /x yet"),
        (500, False, "heard: its queue was full"),
        (None, False, "heard: most messages are lost"),
    ],
)
def test_each_is_told_once(
    losses: Losses, deep: int | None, is_unread: bool, told: str, caplog: pytest.LogCaptureFixture
) -> None:
    """However often more messages are lost."""
    for lost in (MANY_LOSSES, 2 * MANY_LOSSES):
        losses.warn(lost, lost, deep, is_unread=is_unread, is_busy=True)
    assert len([text for text in caplog.messages if text.startswith(told)]) == 1


def test_few_losses(losses: Losses, caplog: pytest.LogCaptureFixture) -> None:
    """Are not told: fewer than half, or too few to judge."""
    losses.warn(MANY_LOSSES - 1, MANY_LOSSES - 1, None, is_unread=False, is_busy=False)
    losses.warn(MANY_LOSSES, 10 * MANY_LOSSES, None, is_unread=False, is_busy=False)
    assert caplog.messages == []
