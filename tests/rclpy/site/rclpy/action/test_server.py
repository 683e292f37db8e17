"""Servers of actions."""

from __future__ import annotations

from typing import Any

import pytest
from action_msgs.srv import CancelGoal
from example_interfaces.action import Fibonacci

from rclpy._rclpy_pybind11 import RCLError
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node
from tests.cases import slow
from tests.rclpy.conftest import Spinner


def send(node: Node, spin: Spinner, order: int = 1, **more: Any) -> Any:
    """A goal's handle at its client."""
    client = ActionClient(node, Fibonacci, "fib")
    assert client.wait_for_server(5)
    future = client.send_goal_async(Fibonacci.Goal(order=order), **more)
    spin(future.done)
    return future.result()


def ended(spin: Spinner, handle: Any) -> Any:
    future = handle.get_result_async()
    spin(future.done)
    return future.result()


@slow
@pytest.mark.parametrize(("verb", "status"), [("succeed", 4), ("abort", 6), ("", 6), ("raise", 6)])
def test_a_goal_ends_as_its_callback_says(node: Node, spin: Spinner, verb: str, status: int) -> None:
    """If it says nothing, or fails, the goal is aborted; feedback comes meanwhile."""
    feedback: list[Any] = []

    def execute(goal: ServerGoalHandle) -> Any:
        assert goal.status == 2
        goal.publish_feedback(Fibonacci.Feedback(sequence=[0, 1]))
        with pytest.raises(TypeError):
            goal.publish_feedback("none")
        if verb == "raise":
            raise ValueError("broken")
        if verb:
            getattr(goal, verb)()
        return Fibonacci.Result(sequence=[goal.request.order])

    ActionServer(node, Fibonacci, "fib", execute)
    handle = send(node, spin, 7, feedback_callback=feedback.append)
    result = ended(spin, handle)
    assert result.status == status
    assert list(result.result.sequence) == ([] if verb == "raise" else [7])
    assert list(feedback[0].feedback.sequence) == [0, 1]


def test_goals_are_taken_on_or_not(node: Node, spin: Spinner) -> None:
    """As the callback says; what is no answer is a no."""
    answers: list[Any] = [GoalResponse.REJECT, "perhaps", GoalResponse.ACCEPT]
    kept: list[ServerGoalHandle] = []
    ActionServer(
        node, Fibonacci, "fib", print, goal_callback=lambda goal: answers.pop(0), handle_accepted_callback=kept.append
    )
    assert [send(node, spin).accepted for _ in range(3)] == [False, False, True]
    assert kept[0].is_active
    with pytest.raises(RCLError, match="invalid transition from state ACCEPTED with event SUCCEED"):
        kept[0].succeed()


def test_a_goal_is_cancelled_if_the_server_agrees(node: Node, spin: Spinner) -> None:
    """Also one that does not run yet."""
    kept: list[ServerGoalHandle] = []
    agrees = [CancelResponse.REJECT, CancelResponse.ACCEPT]

    def execute(goal: ServerGoalHandle) -> Any:
        assert goal.is_cancel_requested
        goal.canceled()
        return Fibonacci.Result()

    ActionServer(
        node,
        Fibonacci,
        "fib",
        execute,
        handle_accepted_callback=kept.append,
        cancel_callback=lambda goal: agrees.pop(0),
    )
    handle = send(node, spin)
    codes = []
    for _ in range(2):
        future = handle.cancel_goal_async()
        spin(future.done)
        codes.append((future.result().return_code, len(future.result().goals_canceling)))
    assert codes == [(1, 0), (0, 1)]
    kept[0].execute()
    assert ended(spin, handle).status == 5
    future = handle.cancel_goal_async()
    spin(future.done)
    assert future.result().return_code == CancelGoal.Response.ERROR_GOAL_TERMINATED


def test_a_server_without_a_cancel_callback(node: Node, spin: Spinner, capfd: pytest.CaptureFixture[str]) -> None:
    """It refuses, as in ROS 2; the warning has the callback that would accept."""
    ActionServer(node, Fibonacci, "fib", print, handle_accepted_callback=lambda goal: None)
    future = send(node, spin).cancel_goal_async()
    spin(future.done)
    assert future.result().return_code == CancelGoal.Response.ERROR_REJECTED
    assert (
        "a request to cancel is refused, as by default: give the ActionServer a cancel_callback"
        in capfd.readouterr().err
    )


def test_cancel_requests_mean_one_goal_some_or_all(node: Node, spin: Spinner) -> None:
    """By id, by time, or by neither."""
    kept: list[ServerGoalHandle] = []
    server = ActionServer(node, Fibonacci, "fib", print, handle_accepted_callback=kept.append)
    for _ in range(3):
        send(node, spin)

    def meant(key: bytes, stamp: Any) -> list[int]:
        info = CancelGoal.Request().goal_info
        info.goal_id.uuid = list(key)
        if stamp is not None:
            info.stamp = stamp
        return [kept.index(goal) for goal in server._graphflow_to_cancel(info)[1]]

    assert meant(bytes(16), None) == [0, 1, 2]
    assert meant(bytes(16), kept[1].stamp) == [0, 1]
    assert meant(bytes(kept[2].goal_id.uuid), kept[0].stamp) == [0, 2]
    assert meant(bytes(kept[1].goal_id.uuid), None) == [1]
    assert meant(b"x" * 16, None) == []


def test_results_are_kept_for_their_time(node: Node, spin: Spinner) -> None:
    """Then the goal is unknown."""

    def execute(goal: ServerGoalHandle) -> Any:
        goal.succeed()
        return Fibonacci.Result()

    server = ActionServer(node, Fibonacci, "fib", execute, result_timeout=0.02)
    handle = send(node, spin)
    spin(lambda: not server._goal_handles)
    assert ended(spin, handle).status == 0
    with pytest.raises(TypeError, match="not callable"):
        server.register_execute_callback(3)  # type: ignore[arg-type]
    server.destroy()
    server.destroy()
    assert node.count_services("/fib/_action/send_goal") == 0


def test_what_callbacks_leave_out(node: Node, spin: Spinner, capfd: pytest.CaptureFixture[str]) -> None:
    """It is told with their line: the end of a goal, what was decided on it, and a feedback."""

    def execute(goal: ServerGoalHandle) -> Any:
        if goal.request.order:
            goal.publish_feedback([1, 2])
        return Fibonacci.Result()

    def decide(goal: Any) -> Any:
        return GoalResponse.ACCEPT if goal.order < 2 else None

    ActionServer(node, Fibonacci, "fib", execute, goal_callback=decide)
    client = ActionClient(node, Fibonacci, "fib")
    for order in range(3):
        sent: Any = client.send_goal_async(Fibonacci.Goal(order=order))
        spin(sent.done)
        if sent.result().accepted:
            ended(spin, sent.result())
    told = capfd.readouterr().err
    aborted = [line for line in told.splitlines() if "assuming aborted" in line]
    line = execute.__code__.co_firstlineno
    assert aborted[0].endswith(f": execute (test_server.py:{line}) returned without goal_handle.succeed()")
    assert "returned without" not in aborted[1]
    assert "write publish_feedback(Fibonacci.Feedback(...))" in told
    line = decide.__code__.co_firstlineno
    assert f"decide (test_server.py:{line}) must return GoalResponse.ACCEPT, and returned None" in told
