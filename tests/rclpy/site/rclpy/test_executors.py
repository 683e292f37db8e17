"""Executors."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable
from typing import Any

import pytest
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import String

import rclpy
from rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import (
    ExternalShutdownException,
    MultiThreadedExecutor,
    ShutdownException,
    SingleThreadedExecutor,
    TimeoutException,
    await_or_execute,
)
from rclpy.node import Node
from rclpy.task import Future
from tests.cases import slow
from tests.until import until


@pytest.fixture
def single(node: Node) -> SingleThreadedExecutor:
    """Has `node`."""
    executor = SingleThreadedExecutor()
    assert executor.add_node(node)
    return executor


@pytest.fixture
def pool(node: Node) -> MultiThreadedExecutor:
    """Has `node`, and two threads."""
    executor = MultiThreadedExecutor(num_threads=2)
    assert executor.add_node(node)
    return executor


def spin_until(executor: Any, condition: Callable[[], object]) -> None:
    limit = time.monotonic() + 5
    while not condition():
        assert time.monotonic() < limit, "it did not come about in time"
        executor.spin_once(timeout_sec=0.05)


def test_a_node_is_in_one_executor(node: Node, single: SingleThreadedExecutor) -> None:
    """The last that it was added to."""
    assert not single.add_node(node)
    other = SingleThreadedExecutor()
    other.add_node(node)
    assert (single.get_nodes(), other.get_nodes()) == ([], [node])
    assert node.executor is other
    other.remove_node(node)
    assert other.get_nodes() == []


@slow
def test_an_error_in_a_callback_leaves_spin(node: Node, single: SingleThreadedExecutor) -> None:
    """And the next callbacks run when it spins again."""
    calls: list[int] = []

    def tick() -> None:
        calls.append(1)
        raise ValueError("broken")

    node.create_timer(0.001, tick)
    for _ in range(2):
        with pytest.raises(ValueError, match="broken"):
            single.spin()
    assert len(calls) == 2


def test_an_error_in_a_pool_leaves_spin_too(node: Node, pool: MultiThreadedExecutor) -> None:
    """At once, though it happened in another thread."""

    def tick() -> None:
        raise ValueError("broken")

    node.create_timer(0.001, tick)
    with pytest.raises(ValueError, match="broken"):
        pool.spin()


def test_spinning_ends_with_the_context(node: Node, single: SingleThreadedExecutor) -> None:
    """By an error if it waited, and quietly when a callback has ended it."""
    threading.Timer(0.02, rclpy.shutdown).start()
    with pytest.raises(ExternalShutdownException):
        single.spin()
    rclpy.init()
    again = Node("again")
    again.create_timer(0.001, rclpy.shutdown)
    rclpy.spin(again)


def test_spinning_a_pool_ends_with_the_context(pool: MultiThreadedExecutor) -> None:
    """Quietly, also in a thread of its own."""
    threading.Timer(0.02, rclpy.shutdown).start()
    pool.spin()


@pytest.mark.parametrize("kind", [SingleThreadedExecutor, lambda: MultiThreadedExecutor(num_threads=3)])
def test_what_follows_an_answer_is_a_task(node: Node, kind: Any) -> None:
    """It is called outside of the client's group, awaited if it is a coroutine function, and its error leaves spin."""
    node.create_service(AddTwoInts, "add", lambda request, response: response)
    client, told = node.create_client(AddTwoInts, "add"), list[str]()
    executor = kind()
    executor.add_node(node)

    def in_a_pool(future: Any) -> None:
        if isinstance(executor, MultiThreadedExecutor):  # the group is free for the answer that this waits for
            client.call(AddTwoInts.Request())
        told.append("called")

    async def awaited(future: Any) -> None:
        await client.call_async(AddTwoInts.Request())
        told.append("awaited")

    def failing(future: Any) -> None:
        raise LookupError("in what follows")

    for follows in (in_a_pool, awaited):
        client.call_async(AddTwoInts.Request()).add_done_callback(follows)
    spin_until(executor, lambda: {*told} == {"called", "awaited"})
    client.call_async(AddTwoInts.Request()).add_done_callback(failing)
    with pytest.raises(LookupError, match="in what follows"):
        executor.spin()


def test_spinning_ends_with_the_executor(single: SingleThreadedExecutor) -> None:
    """Quietly."""
    threading.Timer(0.02, single.shutdown).start()
    single.spin()
    with pytest.raises(ShutdownException):
        single.wait_for_ready_callbacks()
    with SingleThreadedExecutor() as executor:
        pass
    assert executor._is_shutdown


def test_nothing_to_do_in_time(single: SingleThreadedExecutor) -> None:
    """Is no error of `spin_once`, and one of what it asks."""
    began = time.monotonic()
    single.spin_once(timeout_sec=0.02)
    assert time.monotonic() - began >= 0.02
    with pytest.raises(TimeoutException):
        single.wait_for_ready_callbacks(timeout_sec=0)


def test_tasks_run_while_it_spins(single: SingleThreadedExecutor) -> None:
    """Functions, coroutine functions and coroutines; a step at a time."""

    async def work(value: int) -> int:
        await asyncio.sleep(0)
        return value

    tasks = [single.create_task(work, 1), single.create_task(work(2)), single.create_task(max, 3, 1)]
    assert not any(task.done() for task in tasks)
    spin_until(single, lambda: all(task.done() for task in tasks))
    assert [task.result() for task in tasks] == [1, 2, 3]


def test_a_callback_awaits_a_call_in_its_own_group(node: Node, single: SingleThreadedExecutor) -> None:
    """Which lets the answer through only where the group is reentrant: else both wait for ever, as in ROS 2."""
    node.create_service(AddTwoInts, "add", lambda request, response: response, callback_group=ReentrantCallbackGroup())
    done: list[str] = []

    def ask(name: str, group: CallbackGroup) -> None:
        client = node.create_client(AddTwoInts, "add", callback_group=group)
        client.wait_for_service(5)

        async def tick() -> None:
            timer.cancel()
            await client.call_async(AddTwoInts.Request())
            done.append(name)

        timer = node.create_timer(0.001, tick, group)

    ask("reentrant", ReentrantCallbackGroup())
    ask("exclusive", MutuallyExclusiveCallbackGroup())
    spin_until(single, lambda: done)
    for _ in range(5):
        single.spin_once(timeout_sec=0.01)
    assert done == ["reentrant"]


def test_callbacks_of_an_exclusive_group_never_run_together(node: Node, pool: MultiThreadedExecutor) -> None:
    """Those of others do."""
    inside, most, meeting = [0], [0], threading.Barrier(2)
    group = MutuallyExclusiveCallbackGroup()
    met: list[int] = []

    def alone() -> None:
        inside[0] += 1
        most[0] = max(most[0], inside[0])
        time.sleep(0.002)
        inside[0] -= 1

    def together() -> None:
        meeting.wait(5)
        met.append(1)

    timers = [node.create_timer(0.001, alone, group) for _ in range(3)]
    limit = time.monotonic() + 0.05
    while time.monotonic() < limit:
        pool.spin_once(timeout_sec=0.01)
    for timer in timers:
        timer.cancel()
    for _ in range(2):
        node.create_guard_condition(together, ReentrantCallbackGroup()).trigger()
    spin_until(pool, lambda: len(met) == 2)
    assert most == [1]


def test_a_pool_takes_no_more_than_it_has_threads_for(node: Node, pool: MultiThreadedExecutor) -> None:
    """So what waits, waits in the subscription, whose queue is as deep as was asked for."""
    go, heard = threading.Event(), list[str]()

    def slow(message: String) -> None:
        go.wait(5)
        heard.append(message.data)

    node.create_subscription(String, "t", slow, 2, callback_group=ReentrantCallbackGroup())
    publisher = node.create_publisher(String, "t", 10)
    for data in "abcdefg":
        publisher.publish(String(data=data))
        pool.spin_once(timeout_sec=0.02)
    go.set()
    spin_until(pool, lambda: len(heard) == 4)
    assert sorted(heard) == ["a", "b", "f", "g"]


def test_threads_of_a_pool(node: Node) -> None:
    """As many as processors; one alone is told to be a single-threaded executor."""
    assert MultiThreadedExecutor()._executor._max_workers >= 1
    with pytest.warns(UserWarning, match="SingleThreadedExecutor"):
        MultiThreadedExecutor(num_threads=1)


@pytest.mark.parametrize("kind", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_spinning_until_a_future_is_done(node: Node, kind: Any) -> None:
    """Whoever sets it; or until the time is over."""
    executor, future = kind(), Future[int]()
    executor.add_node(node)
    threading.Timer(0.02, future.set_result, (1,)).start()
    executor.spin_until_future_complete(future)
    assert future.done()
    began = time.monotonic()
    executor.spin_until_future_complete(Future(), timeout_sec=0.02)
    assert time.monotonic() - began >= 0.02
    executor.spin_once_until_future_complete(future)
    executor.shutdown()


def test_an_executor_of_ones_own(node: Node) -> None:
    """Takes what is ready, and runs it where it likes."""

    class Own(SingleThreadedExecutor):
        def spin_once(self, timeout_sec: float | None = None) -> None:
            try:
                handler, entity, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
            except TimeoutException:
                return
            runs.append((entity, node))
            threading.Thread(target=handler).start()

    runs: list[Any] = []
    threads: list[str] = []
    executor = Own()
    executor.add_node(node)

    def tick() -> None:
        threads.append(threading.current_thread().name)
        timer.cancel()

    timer = node.create_timer(0.001, tick)
    spin_until(executor, lambda: threads)
    assert runs[0] == (timer, node)
    assert threads != [threading.current_thread().name]


def test_a_group_of_ones_own(node: Node, single: SingleThreadedExecutor) -> None:
    """Is asked before each callback, and told of its end."""

    class Twice(CallbackGroup):
        left, ended = 2, 0

        def can_execute(self, entity: Any) -> bool:
            return self.left > 0

        def beginning_execution(self, entity: Any) -> bool:
            self.left -= 1
            return True

        def ending_execution(self, entity: Any) -> None:
            self.ended += 1

    group, calls = Twice(), list[int]()
    node.create_timer(0.001, lambda: calls.append(1), group)
    for _ in range(6):
        single.spin_once(timeout_sec=0.005)
    assert (calls, group.ended) == ([1, 1], 2)


def test_a_second_thread_may_wait_for_a_future(single: SingleThreadedExecutor, node: Node) -> None:
    """In the executor that another one spins: what ends one of them wakes both, and nothing else does."""
    first, second = Future[int](), Future[int]()
    threads = [threading.Thread(target=single.spin_until_future_complete, args=(f,)) for f in (first, second)]
    threads[0].start()
    until(lambda: len(single._graphflow._asking) == 1)
    threads[1].start()
    until(lambda: len(single._graphflow._asking) == 2)
    first.set_result(7)
    threads[0].join(10)
    assert [thread.is_alive() for thread in threads] == [False, True]
    second.set_result(8)
    threads[1].join(10)
    assert not threads[1].is_alive()


def test_a_second_thread_may_not_spin_the_same_executor(single: SingleThreadedExecutor) -> None:
    """In the same way; it is told so."""
    thread = threading.Thread(target=single.spin)
    thread.start()
    until(lambda: single.spinning._asking)
    with pytest.raises(ValueError, match="already executing"):
        single.spin_once()
    single.shutdown()
    thread.join(5)


def test_functions_are_called_and_coroutine_functions_awaited() -> None:
    """As callbacks are."""

    async def later(value: int) -> int:
        return value

    assert asyncio.run(await_or_execute(later, 1)) == 1
    assert asyncio.run(await_or_execute(max, 1, 2)) == 2


def test_a_future_of_asyncio_may_be_waited_for(single: SingleThreadedExecutor, node: Node) -> None:
    """As for one of rclpy's."""
    loop = asyncio.new_event_loop()
    future: Any = asyncio.Future(loop=loop)
    node.create_timer(0.001, lambda: future.done() or future.set_result(1))
    single.spin_until_future_complete(future, timeout_sec=10)
    assert future.done()
    other: Any = asyncio.Future(loop=loop)
    for _ in range(3):
        single.spin_until_future_complete(other, timeout_sec=0)
    assert len(other._callbacks) == 1
    loop.close()
    single._is_shutdown = True
    assert single.spinning.is_shutdown
