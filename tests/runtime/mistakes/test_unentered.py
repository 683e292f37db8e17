"""Context managers that are not entered."""

from __future__ import annotations

import asyncio
import inspect

import pytest

from graphflow import ActionClient, Node, running, timer
from graphflow.errors import DeclarationError
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.runtime.context import Context
from graphflow.testing import Graph
from graphflow.testing.clock import ManualClock
from graphflow.transport.memory import Network


class Asker(Node):
    goals = ActionClient(Fibonacci, "fibonacci")

    def forget(self) -> None:
        self.goals.send(Fibonacci.Goal(order=3))


async def test_a_forgotten_async_with(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """It is reported with its line, for nodes and goals."""
    running(Asker())
    node = Asker()
    await graph.start(node)
    node.forget()
    line = inspect.getsourcelines(Asker.forget)[1] + 1
    first, second = caplog.messages
    assert first.startswith(f"{__file__}:")
    assert first.endswith("has no effect until it is entered; write async with graphflow.running(Asker()): ...")
    assert second.startswith(
        f"{__file__}:{line}: this has no effect until it is entered; write `async with client.send"
    )


def test_other_ways_to_enter(caplog: pytest.LogCaptureFixture) -> None:
    """Are answered at once, and only once."""
    block = running(Asker())
    with pytest.raises(TypeError, match=r"running\(Asker\(\)\): \.\.\., in an async def main"):
        block.__enter__()  # type: ignore[attr-defined]
    del block
    assert caplog.messages == []


async def test_with_in_place_of_async_with(graph: Graph) -> None:
    """In a coroutine, the form alone is wrong."""
    block = running(Asker())
    with pytest.raises(TypeError, match=r"write async with graphflow\.running\(Asker\(\)\): \.\.\.$"):
        block.__enter__()  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (Asker, r"Asker is a class; create a node: Asker\(\)"),
        ([], r"pass nodes as separate arguments, as in running\(talker, listener\)"),
        ("asker", "'asker' is not a node"),
        (asyncio.sleep, r"sleep\(\) is a coroutine of your own, and not a node: run it by asyncio.run\(sleep\(\)\)"),
        (asyncio.sleep(0), r"sleep\(\) is a coroutine of your own"),
    ],
)
def test_what_is_no_node(given: Node, told: str) -> None:
    """Is refused at the call."""
    with pytest.raises(DeclarationError, match=told):
        running(given)


class Ticking(Node):
    @timer(1.0)
    async def tick(self) -> None: ...


async def test_a_block_that_ends_at_once(graphflow_runner: asyncio.Runner, caplog: pytest.LogCaptureFixture) -> None:
    """Its nodes have handlers, which cannot run meanwhile."""
    context = Context(Network().session(asyncio.get_running_loop()), clock=ManualClock())
    async with running(Ticking(), context=context):
        line = inspect.currentframe().f_lineno - 1  # type: ignore[union-attr]
    async with running(Ticking(), context=context):
        await asyncio.sleep(0)
    async with running(Asker(), context=context):
        pass
    with pytest.raises(ValueError, match="an own error"):
        async with running(Ticking(), context=context):
            raise ValueError("an own error")
    [text] = caplog.messages
    assert text.startswith(f"{__file__}:{line}: this block awaits nothing, so that no handler of ticking runs; await")
