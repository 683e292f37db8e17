"""Calls of other threads to a node."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import pytest

from graphflow import ClosedError, MessageInfo, Node, WrongThread, subscription
from graphflow.errors import Place
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Trigger
from graphflow.runtime.mistakes import other_threads
from graphflow.runtime.mistakes.other_threads import report_foreign_calls
from graphflow.system import LOOP_VARIABLE, is_portable
from graphflow.testing import Graph
from graphflow.transport.event_loop.loop import new_event_loop
from tests.runtime.cast import Talker


async def in_a_thread(fn: Callable[[], object]) -> object:
    """Return the result of a function called in a thread unknown to graphflow."""
    with ThreadPoolExecutor(1, "vendor") as pool:
        return await asyncio.wrap_future(pool.submit(fn))


async def test_any_thread_may_publish(graph: Graph) -> None:
    """Messages leave in the order of their numbers."""
    sender, numbers = Talker(), list[int]()
    await graph.start(sender)
    publisher = sender.create_publisher(String, "/many", 10_000)

    class Counting(Node):
        @subscription(String, "/many", 10_000)
        async def heard(self, _: String, info: MessageInfo) -> None:
            numbers.append(info.sequence)

    await graph.start(Counting())

    def publish() -> None:
        for _ in range(500):
            publisher.publish(String(data="x"))

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        publish()
        threads = [asyncio.ensure_future(in_a_thread(publish)) for _ in range(4)]
        await asyncio.sleep(0)
        publish()
        await asyncio.gather(*threads)
    finally:
        sys.setswitchinterval(interval)
    await graph.settle()
    assert numbers == list(range(1, 3001))


async def test_any_thread_may_ask_the_loop(graph: Graph) -> None:
    """For a call, a coroutine, and the end of the node."""
    node, called, done = Talker(), asyncio.Event(), asyncio.Event()
    await graph.start(node)

    async def coroutine() -> None:
        done.set()

    await in_a_thread(lambda: node.call_soon(called.set))
    await in_a_thread(lambda: node.spawn(coroutine))
    await in_a_thread(node.shutdown)
    await asyncio.wait_for(asyncio.gather(called.wait(), done.wait(), node.wait_ended()), 10.0)


async def test_an_error_in_what_a_thread_asks_for_is_told(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """It is logged, and does not end the node."""
    node = Talker()
    await graph.start(node)
    await in_a_thread(lambda: node.call_soon(divmod, 1, 0))
    await graph.settle()
    assert "call_soon of divmod" in caplog.text
    assert "ZeroDivisionError" in caplog.text
    with pytest.raises(TypeError, match=r"spawn\(on_start\) runs it"):
        node.call_soon(node.on_start)


async def test_what_a_thread_may_not_do(graph: Graph) -> None:
    """It is refused by name, with the way that there is."""
    node = Talker()
    await graph.start(node)
    timer = node.create_timer(1.0, lambda: None)
    for forbidden in (
        lambda: node.create_publisher(String, "late"),
        lambda: node.declare_parameter("late", 1),
        lambda: asyncio.run(node.offload(print)),
        lambda: asyncio.run(node.enter(ThreadPoolExecutor(1))),
        timer.reset,
        timer.cancel,
    ):
        with pytest.raises(WrongThread, match=r"thread 'vendor_0', only on the event loop; node.call_soon\(fn, ...\)"):
            await in_a_thread(forbidden)
    client = node.create_client(Trigger, "nobody")
    with pytest.raises(WrongThread, match=r"call_sync\(request\) waits for the response"):
        await in_a_thread(lambda: asyncio.run(client.call(Trigger.Request())))


async def test_a_thread_that_goes_on_after_the_end_is_told(graph: Graph) -> None:
    """By an error of graphflow's."""
    node = Talker()
    await graph.start(node)
    publisher = node.create_publisher(String, "/many")
    await node._core.stop()
    for late in (lambda: publisher.publish(String()), lambda: node.call_soon(print), lambda: node.spawn(node.on_start)):
        with pytest.raises(ClosedError):
            await in_a_thread(late)


WAY = (
    "changes the event loop's state, which takes effect only when something else wakes the loop, perhaps seconds later"
)


@pytest.mark.skipif(is_portable(), reason="asyncio's own loop does not look")
def test_what_a_thread_does_to_the_loop(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    """It is reported once with its line and the correction, with or without asyncio code between."""
    monkeypatch.setenv(LOOP_VARIABLE, "asyncio")

    async def main() -> None:
        loop = asyncio.get_running_loop()
        report_foreign_calls(loop)
        queue, future, event = asyncio.Queue[int](), loop.create_future(), asyncio.Event()
        waiting = asyncio.gather(queue.get(), future, event.wait())
        await asyncio.sleep(0)

        def vendor() -> None:
            for _ in range(2):
                queue.put_nowait(1)
                event.set()
            future.set_result(None)
            loop.call_soon_threadsafe(print)

        with ThreadPoolExecutor(1, "vendor") as pool:
            pool.submit(vendor).result()  # the loop stands still: it may not change what the thread goes through
        await waiting
        lines = [vendor.__code__.co_firstlineno + n for n in (2, 3, 4)]
        ways = ["queue.put_nowait, ...", "event.set", "future.set_result, ..."]
        assert [record.message for record in caplog.records] == [
            f"{__file__}:{line}: thread 'vendor_0' {WAY}; write self.call_soon({way})"
            for line, way in zip(lines, ways, strict=True)
        ]

    with asyncio.Runner(loop_factory=new_event_loop) as runner:
        runner.run(main())


def test_only_so_many_lines_are_remembered(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    """Beyond them, nothing is told."""
    monkeypatch.setattr(other_threads, "PLACES_BOUND", 1)
    reported = set[Place]()
    other_threads._report(reported, sys._getframe())
    other_threads._report(reported, sys._getframe())
    assert len(caplog.messages) == len(reported) == 1
