"""Mistakes that are told when a node starts."""

from __future__ import annotations

import asyncio
import logging

import pytest

from graphflow import Node, timer
from graphflow.analysis.mistakes.calls.hidden_logs import HIDDEN
from graphflow.runtime.context import Context
from graphflow.runtime.mistakes import at_start
from graphflow.runtime.mistakes.at_start import warn_at_start
from graphflow.runtime.mistakes.source import slips
from graphflow.runtime.mistakes.source.module_variables import Exchanged
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from tests.cases import slow


class Robot(Node):
    """A node with a slip, and a list of its class."""

    crumbs_on_the_way: list[int] = []  # noqa: RUF012

    def on_strat(self) -> None:
        self.crumbs_on_the_way.append(1)


@slow
@pytest.mark.parametrize("is_alone", [True, False])
def test_slips_and_shared_lists(caplog: pytest.LogCaptureFixture, is_alone: bool) -> None:
    """Both are warnings; a node that is alone in its process shares nothing."""
    robot, other = (object.__new__(Robot) for _ in range(2))
    warn_at_start(logging.getLogger("test"), robot, [] if is_alone else [("/other", other)])
    slip, *shared = caplog.messages
    assert "did you mean on_start?" in slip
    assert ["`crumbs_on_the_way = []` in the class is one list" in text for text in shared] == [True] * (not is_alone)


@pytest.mark.parametrize("level", [logging.DEBUG, logging.INFO])
def test_a_log_that_is_shown(caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch, level: int) -> None:
    """A hint to the log level is left out where the level is given."""
    monkeypatch.setattr(slips, "slips", lambda cls: (f"robot.py:3: {HIDDEN}",))
    log = logging.getLogger("test")
    log.setLevel(level)
    warn_at_start(log, object.__new__(Robot), [], is_regrouped=True)
    assert caplog.messages == ([] if level == logging.DEBUG else [f"robot.py:3: {HIDDEN}"])


class Other(Node):
    """A class whose nodes set a variable."""


@pytest.mark.parametrize("is_together", [True, False])
async def test_variables_of_another_process(
    graph: Graph, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch, is_together: bool
) -> None:
    """They are told some seconds after the start, unless a node of the other class is there."""
    monkeypatch.setattr(at_start, "exchanged", lambda cls: (Exchanged(Other, "alone"),) if cls is Robot else ())
    context = Context(graph.network.session(asyncio.get_running_loop()), clock=graph.clock)
    for node in (Robot(), Other()) if is_together else (Robot(),):
        await core_of(node).start(context)
        graph.nodes.append(node)
    await graph.clock.advance(5.0)
    assert caplog.messages.count("alone") == (not is_together)


class Odometer(Node):
    """A node that loses an update."""

    total = 0

    @timer(1.0)
    async def spend(self) -> None:
        self.total -= 1

    @timer(1.0)
    async def double(self) -> None:
        total = self.total
        await self.clock.sleep(0.5)
        self.total = 2 * total


@pytest.mark.parametrize("is_regrouped", [True, False])
def test_slips_that_groups_may_prevent(caplog: pytest.LogCaptureFixture, is_regrouped: bool) -> None:
    """They are not told if a graph file changes the groups."""
    warn_at_start(logging.getLogger("test"), object.__new__(Odometer), [], is_regrouped=is_regrouped)
    assert ["meanwhile is lost" in text for text in caplog.messages] == [True] * (not is_regrouped)
