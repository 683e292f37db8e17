"""Clients of actions."""

from __future__ import annotations

import threading
from typing import Any

import pytest
from example_interfaces.action import Fibonacci

import rclpy
from graphflow.rclpy import node_bridge
from rclpy._rclpy_pybind11 import RCLError
from rclpy.action import ActionClient, ActionServer, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.impl.nodes import internals_of
from rclpy.node import Node
from tests.rclpy.conftest import Spinner


def succeed(goal: ServerGoalHandle) -> Any:
    goal.succeed()
    return Fibonacci.Result(sequence=[1, 2])


def test_another_thread_may_block_on_a_goal(node: Node, spin: Spinner) -> None:
    """From sending to its result, or step by step."""
    ActionServer(node, Fibonacci, "fib", succeed)
    client, results = ActionClient(node, Fibonacci, "fib"), list[Any]()
    client.wait_for_server(5)
    thread = threading.Thread(target=lambda: results.append(client.send_goal(Fibonacci.Goal())))
    thread.start()
    spin(lambda: results)
    thread.join()
    assert (results[0].status, list(results[0].result.sequence)) == (4, [1, 2])
    future = client.send_goal_async(Fibonacci.Goal())
    spin(future.done)
    handle: Any = future.result()
    thread = threading.Thread(target=lambda: results.append(handle.get_result()))
    thread.start()
    spin(lambda: len(results) == 2)
    thread.join()
    assert handle.accepted
    assert "accepted=True" in repr(handle)


def test_both_ends_are_made_while_the_node_is_spun(node: Node, spin: Spinner, monkeypatch: pytest.MonkeyPatch) -> None:
    """By another thread, which must not see them half made: here a turn comes after each of their parts."""
    ActionServer(node, Fibonacci, "fib", succeed)  # whose status is kept for those who come later
    client = ActionClient(node, Fibonacci, "fib")
    future = client.send_goal_async(Fibonacci.Goal())
    spin(future.done)
    real = node_bridge.add

    def add(*args: Any) -> Any:
        endpoint = real(*args)
        for _ in range(3):
            spin.executor.spin_once(timeout_sec=0.01)
        return endpoint

    monkeypatch.setattr(node_bridge, "add", add)
    for _ in range(3):
        ActionClient(node, Fibonacci, "fib")
        ActionServer(node, Fibonacci, "fib", succeed)


def test_feedback_comes_before_the_result(node: Node, spin: Spinner) -> None:
    """All of it, however much there is when the executor has time."""

    def work(goal: ServerGoalHandle) -> Any:
        for i in range(5):
            goal.publish_feedback(Fibonacci.Feedback(sequence=[i]))
        return succeed(goal)

    ActionServer(node, Fibonacci, "fib", work)
    client, heard = ActionClient(node, Fibonacci, "fib"), list[int]()
    future = client.send_goal_async(Fibonacci.Goal(), lambda message: heard.append(message.feedback.sequence[0]))
    spin(future.done)
    handle: Any = future.result()
    result = handle.get_result_async()
    spin(result.done)
    assert heard == [0, 1, 2, 3, 4]


def test_a_server_is_there_when_all_of_it_is(node: Node) -> None:
    """Waiting ends in time."""
    client = ActionClient(node, Fibonacci, "fib")
    assert not client.wait_for_server(0.02)
    server = ActionServer(node, Fibonacci, "fib", succeed)
    assert client.wait_for_server(5)
    assert client.server_is_ready()
    server.destroy()
    assert not client.server_is_ready()


def test_handles_know_the_states_of_their_goals(node: Node, spin: Spinner) -> None:
    """As the server publishes them."""
    kept: list[ServerGoalHandle] = []
    ActionServer(node, Fibonacci, "fib", succeed, handle_accepted_callback=kept.append)
    client = ActionClient(node, Fibonacci, "fib", callback_group=ReentrantCallbackGroup())
    client.wait_for_server(5)
    future = client.send_goal_async(Fibonacci.Goal())
    spin(future.done)
    handle: Any = future.result()
    kept[0].execute()
    spin(lambda: handle.status == 4)
    assert bytes(handle.goal_id.uuid) == bytes(kept[0].goal_id.uuid)
    assert handle.stamp.sec > 0


def test_what_is_no_goal_is_refused(node: Node) -> None:
    """And a client that was destroyed is gone."""
    client = ActionClient(node, Fibonacci, "fib")
    for wrong in (lambda: client.send_goal("x"), lambda: client.send_goal_async("x")):
        with pytest.raises(TypeError, match=r"make one, as in Fibonacci\.Goal\(order=\.\.\.\)"):
            wrong()
    client.destroy()
    client.destroy()
    assert node.count_clients("/fib/_action/send_goal") == 0


def test_nobody_is_asked_for_servers_after_the_end(node: Node) -> None:
    """So that a loop of `wait_for_server` ends."""
    client = ActionClient(node, Fibonacci, "fib")
    threading.Timer(0.02, rclpy.shutdown).start()
    with pytest.raises(RCLError, match="Failed to check if action server is available"):
        client.wait_for_server()


def test_an_error_in_what_follows_an_answer_leaves_spin(node: Node, spin: Spinner) -> None:
    """It is a task of the executor."""
    ActionServer(node, Fibonacci, "fib", succeed)
    client = ActionClient(node, Fibonacci, "fib")
    assert client.wait_for_server(5)

    def follow(future: Any) -> None:
        raise LookupError("in what follows")

    client.send_goal_async(Fibonacci.Goal()).add_done_callback(follow)
    with pytest.raises(LookupError, match="in what follows"):
        spin(lambda: False)


def test_feedback_is_asked_for_in_order(node: Node) -> None:
    """With answers, which come by another way; what is not waited for with them is not."""
    client = ActionClient(node, Fibonacci, "count")
    assert (internals_of(client).feedback.in_order, internals_of(client).status.in_order) == (True, False)


def test_the_result_of_a_goal_that_was_rejected(node: Node, spin: Spinner, caplog: pytest.LogCaptureFixture) -> None:
    """Has nothing in it, as in ROS 2; that is told with the line."""
    ActionServer(node, Fibonacci, "fib", succeed, goal_callback=lambda _: GoalResponse.REJECT)
    client = ActionClient(node, Fibonacci, "fib")
    sent = client.send_goal_async(Fibonacci.Goal())
    spin(sent.done)
    handle: Any = sent.result()
    result = handle.get_result_async()
    spin(result.done)
    assert list(result.result().result.sequence) == []
    [text] = [record.getMessage() for record in caplog.records if record.name == "graphflow"]
    assert text.startswith("test_client.py:")
    assert text.endswith(
        ": the goal was rejected and has no result: check goal_handle.accepted before get_result_async()"
    )
