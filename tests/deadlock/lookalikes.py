"""Programs that look like deadlocks and go on: how they are tested, and what happens outside of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from graphflow import Node
from graphflow.executor.clock import Clock
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from tests.deadlock.cast import Caplog, Robot, reports, say


def in_three_seconds(do: Callable[[], Any]) -> Node:
    """Somebody outside who does something."""
    outside = Node("outside")
    outside.create_timer(3.0, do)
    return outside


def three_seconds_from_now(clock: Clock) -> int:
    return clock.monotonic_ns() + 3_000_000_000


def legal(program: type[Robot]) -> Any:
    return pytest.param(program, id=program.__name__)


async def goes_on(graph: Graph, caplog: Caplog, robot: Robot) -> None:
    """Run a program: nothing is ever said of it, though it waits for seconds while others of its group queue."""
    graph.deadlock = "report"
    await graph.start(robot, *robot.others())
    await say(graph, "/go", "/arrive", "/arrive")
    for _ in range(20):
        await graph.clock.advance(0.1)
    assert any(runner.active for runner in core_of(robot).runners)
    for _ in range(30):
        await graph.clock.advance(0.1)

    assert reports(caplog) == []
    assert not any(runner.active for runner in core_of(robot).runners)
    assert "Error" not in caplog.text
