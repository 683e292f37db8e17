"""Mistakes that are told when a node starts."""

from __future__ import annotations

import logging

import pytest

from graphflow import Node
from graphflow.runtime.mistakes.at_start import warn_at_start


class Robot(Node):
    """A node with a slip, and a list of its class."""

    points: list[int] = []  # noqa: RUF012

    def on_strat(self) -> None:
        self.points.append(1)


@pytest.mark.parametrize("is_alone", [True, False])
def test_slips_and_shared_lists(caplog: pytest.LogCaptureFixture, is_alone: bool) -> None:
    """Both are warnings; a node that is alone in its process shares nothing."""
    robot, other = (object.__new__(Robot) for _ in range(2))
    warn_at_start(logging.getLogger("test"), robot, [] if is_alone else [("/other", other)])
    slip, *shared = caplog.messages
    assert "did you mean on_start?" in slip
    assert ["`points = []` in the class is one list" in text for text in shared] == [True] * (not is_alone)
