"""Test support for nodes: a graph in memory, a clock that moves only on demand, and taps on topics.

    async def test_talker_greets_twice_in_two_seconds(graph: Graph) -> None:
        await graph.start(Talker(rate=1.0))
        heard = graph.tap(String, "/chatter")

        await graph.clock.advance(2.0)

        assert [m.data for m in heard] == ["Hello World: 1", "Hello World: 2"]

Installing graphflow adds the fixture `graph` to pytest, and runs `async def` tests that use it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from graphflow.testing.clock import ManualClock
    from graphflow.testing.graph import Graph, Tap

__all__ = ["Graph", "ManualClock", "Tap"]


def __getattr__(name: str) -> object:
    # Imported on first use: every pytest run loads the plugin beside this module, and most runs have no graphs.
    if name == "ManualClock":
        from graphflow.testing.clock import ManualClock

        return ManualClock
    if name in __all__:
        from graphflow.testing import graph

        value: object = getattr(graph, name)
        return value
    raise AttributeError(f"module 'graphflow.testing' has no attribute {name!r}")
