"""For tests of nodes: a graph in memory, a clock that moves only when told, and taps on topics.

    async def test_talker_greets_twice_in_two_seconds(graph: Graph) -> None:
        await graph.start(Talker(rate=1.0))
        heard = graph.tap(String, "/chatter")

        await graph.clock.advance(2.0)

        assert [m.data for m in heard] == ["Hello World: 1", "Hello World: 2"]

Installing graphflow gives pytest the fixture `graph`, and runs `async def` tests that use it.
"""

from graphflow.testing.clock import ManualClock
from graphflow.testing.graph import Graph, Tap

__all__ = ["Graph", "ManualClock", "Tap"]
