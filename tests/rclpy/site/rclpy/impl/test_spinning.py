"""What an executor does next."""

from __future__ import annotations

from functools import partial
from typing import Any

import pytest
from std_msgs.msg import String

from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.spinning import Run, TimeoutException
from rclpy.node import Node
from rclpy.task import Future


def test_tasks_come_first_then_timers_then_what_has_arrived(node: Node) -> None:
    """Of what is ready at the same time; each once a round."""
    executor, order = SingleThreadedExecutor(), list[str]()
    executor.add_node(node)
    guard = node.create_guard_condition(lambda: order.append("guard"))
    node.create_subscription(String, "t", lambda message: order.append("message"), 10)
    publisher = node.create_publisher(String, "t", 10)

    def tick() -> None:
        order.append("timer")
        timer.cancel()

    timer = node.create_timer(1e-6, tick)
    guard.trigger()
    for _ in range(2):
        publisher.publish(String())
    executor.create_task(lambda: order.append("task"))
    for _ in range(5):
        executor.spin_once(timeout_sec=0.05)
    assert order == ["task", "timer", "message", "guard", "message"]


def test_a_coroutine_goes_on_when_what_it_awaits_is_done(node: Node) -> None:
    """And not before: meanwhile nothing is stepped, and its group is held."""
    executor, steps, future = SingleThreadedExecutor(), list[str](), Future[int]()
    executor.add_node(node)

    async def tick() -> None:
        timer.cancel()
        steps.append("began")
        steps.append(str(await future))

    timer = node.create_timer(0.0001, tick)
    executor.spin_once(timeout_sec=1)
    (run,) = executor.spinning.running
    assert (run.entity, run.node, run.thread) == (timer, node, 0)
    assert not node.default_callback_group.can_execute(timer)
    with pytest.raises(TimeoutException):
        executor.wait_for_ready_callbacks(timeout_sec=0)
    future.set_result(3)
    executor.spin_once(timeout_sec=1)
    assert steps == ["began", "3"]
    assert node.default_callback_group.can_execute(timer)
    assert not executor.spinning.running


def test_a_run_that_is_cancelled_gives_its_place_back(node: Node) -> None:
    """While it is suspended."""
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    forever: Future[Any] = Future()

    async def tick() -> None:
        timer.cancel()
        await forever

    timer = node.create_timer(0.0001, tick)
    executor.spin_once(timeout_sec=1)
    (run,) = executor.spinning.running
    assert isinstance(run, Run)
    run.cancel()
    assert node.default_callback_group.can_execute(timer)


def test_a_node_that_was_removed_has_nothing_to_do(node: Node) -> None:
    """Even what was found before."""
    executor, calls, other = SingleThreadedExecutor(), list[str](), Node("other")
    for each in (node, other):
        executor.add_node(each)
        each.create_guard_condition(partial(calls.append, each.get_name())).trigger()
    executor.spin_once(timeout_sec=1)
    executor.remove_node(other)
    executor.spin_once(timeout_sec=0.01)
    assert calls == ["node"]
