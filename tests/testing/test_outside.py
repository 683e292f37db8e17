"""Work in threads, pools and child processes takes no time of the graph's."""

from __future__ import annotations

import asyncio
import re
import sys
import threading
import time
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any, ClassVar

import pytest

from graphflow import Client, Node, Publisher, service, subscription, timer
from graphflow.msgs.std_msgs.msg import Int32
from graphflow.msgs.std_srvs.srv import Trigger
from graphflow.testing import Graph
from graphflow.testing import clock as clock_module

SLOW = 0.02
Way = Callable[[Node], Coroutine[Any, Any, int]]


def count() -> int:
    time.sleep(SLOW)
    return 1


async def by_offload(node: Node) -> int:
    return await node.offload(count)


async def by_to_thread(node: Node) -> int:
    return await asyncio.to_thread(count)


async def by_pool(node: Node) -> int:
    with ThreadPoolExecutor() as pool:
        return await asyncio.get_running_loop().run_in_executor(pool, count)


async def by_process(node: Node) -> int:
    code = f"import time; time.sleep({SLOW}); print(1)"
    process = await asyncio.create_subprocess_exec(sys.executable, "-c", code, stdout=asyncio.subprocess.PIPE)
    out, _ = await process.communicate()
    return int(out)


class Worker(Node):
    out = Publisher(Int32, "out")

    def __init__(self, way: Way) -> None:
        super().__init__("worker")
        self.way = way
        self.now: list[float] = []

    @timer(hz=10.0)
    async def work(self) -> None:
        self.out.publish(Int32(data=await self.way(self)))
        self.now.append(round(self.clock.monotonic_ns() / 1e9, 3))


@pytest.mark.parametrize("way", [by_offload, by_to_thread, by_pool, by_process])
async def test_time_stands_still_meanwhile(graph: Graph, way: Way) -> None:
    """Each round of a timer is over before the next is due."""
    node = Worker(way)
    await graph.start(node)
    heard = graph.tap(Int32, "/out")
    await graph.clock.advance(0.3)
    assert (len(heard), node.now) == (3, [0.1, 0.2, 0.3])


async def test_a_handler_in_a_thread_is_waited_for(graph: Graph) -> None:
    """So `settle` is enough after a message for it."""

    class Threaded(Node):
        seen = 0

        @subscription(Int32, "in", thread=True)
        def heard(self, message: Int32) -> None:
            time.sleep(SLOW)
            self.seen += message.data

    node = Threaded()
    await graph.start(node)
    graph.publisher(Int32, "/in").publish(Int32(data=2))
    await graph.settle()
    assert node.seen == 2


def for_ever(ends: threading.Event) -> int:
    ends.wait(5)
    return 1


@pytest.mark.parametrize("by", ["offload", "to_thread"])
async def test_a_thread_that_does_not_end_is_named(graph: Graph, monkeypatch: pytest.MonkeyPatch, by: str) -> None:
    """Rather than that the test goes on without it."""
    monkeypatch.setattr(clock_module, "OUTSIDE_LIMIT", 0.05)
    ends = threading.Event()
    ways: dict[str, Way] = {
        "offload": lambda node: node.offload(for_ever, ends),
        "to_thread": lambda node: asyncio.to_thread(for_ever, ends),
    }
    await graph.start(Worker(ways[by]))
    told = "the graph does not settle: after 0.05 s it still waits for for_ever in a thread; replace it with a fake"
    with pytest.raises(RuntimeError, match=re.escape(told)):
        await graph.clock.advance(0.1)
    graph.waits_outside = False
    await graph.clock.advance(0.1)
    ends.set()
    graph.waits_outside = True
    await graph.settle()


async def test_a_thread_that_waits_for_an_answer_lets_time_pass(graph: Graph) -> None:
    """The result may need simulated time."""

    class Server(Node):
        @service(Trigger, "slow")
        async def slow(self, request: Trigger.Request) -> Trigger.Response:
            await self.clock.sleep(1.0)
            return Trigger.Response(success=True)

    class Caller(Node):
        slow = Client(Trigger, "slow")
        answers: ClassVar[list[bool]] = []

        @subscription(Int32, "in", thread=True)
        def ask(self, message: Int32) -> None:
            self.answers.append(self.slow.call_sync(Trigger.Request()).success)

    await graph.start(Server(), Caller())
    graph.publisher(Int32, "/in").publish(Int32())
    await graph.settle()
    assert not Caller.answers
    await graph.clock.advance(1.0)
    assert Caller.answers == [True]
