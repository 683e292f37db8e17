"""The summaries of tf2_monitor."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from graphflow.testing import Graph
from graphflow.tf import Transform


async def test_it_prints_summaries(
    graph: Graph, program: Callable[[str], Any], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of all frames, and of the chain between two; until there is one, what is missing is logged."""
    kind = program("tf2_ros/tf2_monitor")["Monitor"]
    everything, chain = kind("all"), kind("chain")
    chain.between = ("map", "base")
    await graph.start(everything, chain)
    await graph.clock.advance(1.0)
    everything.tf.send(Transform.of("map", "base"))
    await graph.clock.advance(1.0)
    out = capsys.readouterr().out
    assert "RESULTS: for all Frames" in out
    assert "RESULTS: for map to base\nChain is: map -> base\nNet delay     avg = 1: max = 1\n" in out
