"""Timers whose runs outlast their periods."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow import Node, timer
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph


class Control(Node):
    """A timer of 10 Hz whose runs take longer."""

    def __init__(self, *takes: float, **params: Any) -> None:
        super().__init__(**params)
        self.takes = list(takes)

    @timer(0.1)
    async def control(self) -> None:
        await self.clock.sleep(self.takes.pop(0) if self.takes[1:] else self.takes[0])


def told(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.message for record in caplog.records if "is due every" in record.message]


async def test_runs_that_outlast_the_period(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """They are reported once with their line, and listed while they continue."""
    node = Control(*[0.95] * 6, 0.01)
    await graph.start(node)
    await graph.clock.advance(2.5)
    assert told(caplog) == []
    await graph.clock.advance(2.0)
    line = Control.control.__code__.co_firstlineno + 2
    assert told(caplog) == [
        "timer control is due every 0.1 s, but its runs take longer (test_overruns.py:"
        f"{line} in control); 28 periods were skipped in 3.0 s: give it a longer period, or start the long work with "
        "self.spawn(...)"
    ]
    assert core_of(node).complaints() == told(caplog)
    await graph.clock.advance(5.0)
    assert core_of(node).complaints() == []
    node.takes = [0.95]
    await graph.clock.advance(5.0)
    assert core_of(node).complaints() != []
    assert len(told(caplog)) == 1


@pytest.mark.parametrize("takes", [(0.09,), (9.0, 0.01), (0.95, 0.95, 0.01) * 9, (0.95, 0.95, 0.01)])
async def test_runs_that_may_take_long(
    graph: Graph, caplog: pytest.LogCaptureFixture, takes: tuple[float, ...]
) -> None:
    """One now and then, or the first, are as it was meant."""
    node = Control(*takes)
    await graph.start(node)
    await graph.clock.advance(15.0)
    assert told(caplog) == []
    assert core_of(node).complaints() == []
