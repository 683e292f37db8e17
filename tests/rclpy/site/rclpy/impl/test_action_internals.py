"""The internals of action clients and servers."""

from __future__ import annotations

from typing import Any

import pytest
from example_interfaces.action import Fibonacci

from rclpy.action import ActionClient, ActionServer
from rclpy.impl.nodes import internals_of
from rclpy.node import Node
from tests.rclpy.conftest import Spinner


def succeed(goal: Any) -> Any:
    goal.succeed()
    return Fibonacci.Result()


def test_the_endpoints_are_there_until_the_end(node: Node) -> None:
    """Under the action's full name; closing withdraws them, and nothing is ready any more."""
    client, server = ActionClient(node, Fibonacci, "fib"), ActionServer(node, Fibonacci, "fib", succeed)
    calls, answers = internals_of(client), internals_of(server)
    assert {calls.full_name, answers.full_name} == {"/fib"}
    assert {calls.action_name, answers.action_name} == {"fib"}
    parts = ["send_goal", "cancel_goal", "get_result"]
    assert [one.name for one in calls.clients] == [f"/fib/_action/{part}" for part in parts]
    assert [one.name for one in answers.services] == [f"/fib/_action/{part}" for part in parts]
    assert calls.has_server()
    server.destroy()
    client.destroy()
    assert [one.is_open or one.has_work() for one in (calls, answers)] == [False, False]
    assert node.count_clients("/fib/_action/send_goal") == node.count_services("/fib/_action/send_goal") == 0


def test_a_call_is_pending_until_its_answer(node: Node, spin: Spinner) -> None:
    """A goal is known from its acceptance to its result; a server forgets it when told to."""
    client, server = ActionClient(node, Fibonacci, "fib"), ActionServer(node, Fibonacci, "fib", succeed)
    calls, answers = internals_of(client), internals_of(server)
    sent = client.send_goal_async(Fibonacci.Goal(order=1))
    assert [future for future, _ in calls.waiting.values()] == [sent]
    spin(sent.done)
    handle: Any = sent.result()
    assert calls.waiting == {}
    ended = handle.get_result_async()
    spin(ended.done)
    assert (ended.result().status, handle.status, calls.handles) == (4, 4, {})
    (goal,) = answers.handles.values()
    goal.destroy()
    assert answers.handles == {}


def test_feedback_of_another_type_is_refused(node: Node) -> None:
    """With the line to write."""
    inner = internals_of(ActionServer(node, Fibonacci, "fib", succeed))
    with pytest.raises(TypeError, match=r"write publish_feedback\(Fibonacci\.Feedback\(\.\.\.\)\)"):
        inner.publish_feedback(Fibonacci.Impl.SendGoalService.Request().goal_id, 3)
