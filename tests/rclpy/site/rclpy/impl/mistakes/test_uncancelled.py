"""Goals that go on although they are cancelled."""

from __future__ import annotations

from typing import Any

import pytest
from example_interfaces.action import Fibonacci

from rclpy.action import ActionClient, ActionServer, CancelResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node
from tests.rclpy.conftest import Spinner


@pytest.mark.parametrize("look", [None, "is_cancel_requested", "status"])
@pytest.mark.parametrize("sent", [0, 1, 2])
def test_a_goal_that_does_not_look_whether_it_is_cancelled(
    node: Node, spin: Spinner, capfd: pytest.CaptureFixture[str], sent: int, look: str | None
) -> None:
    """The warning has the line that looks; it comes once, with the second feedback or at the end."""
    kept: list[ServerGoalHandle] = []
    ActionServer(
        node,
        Fibonacci,
        "fib",
        print,
        handle_accepted_callback=kept.append,
        cancel_callback=lambda goal: CancelResponse.ACCEPT,
    )
    client = ActionClient(node, Fibonacci, "fib")
    sent_goal: Any = client.send_goal_async(Fibonacci.Goal())
    spin(sent_goal.done)
    [goal] = kept
    assert not goal.is_cancel_requested
    future = sent_goal.result().cancel_goal_async()
    spin(future.done)
    if look is not None:
        getattr(goal, look)
    for n in range(sent):
        goal.publish_feedback(Fibonacci.Feedback())
        assert ("goes on" in capfd.readouterr().err) is (look is None and n == 1)
    goal.succeed()
    assert (
        "the goal is cancelled, and goes on: where it is executed, write in the loop "
        "if goal_handle.is_cancel_requested: goal_handle.canceled(); return Fibonacci.Result()"
        in capfd.readouterr().err
    ) is (look is None and sent < 2)
