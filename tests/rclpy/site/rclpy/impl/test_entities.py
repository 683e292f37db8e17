"""What entities are called."""

from __future__ import annotations

from typing import Any

from example_interfaces.action import Fibonacci
from std_msgs.msg import String
from std_srvs.srv import Trigger

from graphflow.analysis.class_source import ANSWERED
from rclpy.action import ActionClient, ActionServer
from rclpy.impl.entities import after_answers, arrived, callbacks_of, role_of
from rclpy.impl.nodes import internals_of
from rclpy.node import Node
from tests.until import until


def test_each_is_called_by_its_callback(node: Node) -> None:
    """Clients have none; they are called by what they ask."""

    def heard(*_: object) -> None:
        """Does nothing."""

    rate = node.create_rate(1.0)
    made: list[tuple[Any, str]] = [
        (node.create_timer(1.0, heard), "timer heard"),
        (node.create_subscription(String, "news", heard, 1), "subscription heard"),
        (node.create_service(Trigger, "ask", heard), "service heard"),
        (node.create_client(Trigger, "ask"), "reply /ask"),
        (node.create_guard_condition(heard), "guard_condition heard"),
        (ActionServer(node, Fibonacci, "count", heard), "action heard"),
        (ActionClient(node, Fibonacci, "count"), "reply /count"),
        (rate._timer, "timer rate"),
    ]
    assert [role_of(entity).label for entity, _ in made] == [label for _, label in made]
    assert [role_of(entity).is_inner for entity, _ in made] == [False] * 7 + [True]


def test_who_is_told_of_an_answer(node: Node) -> None:
    """A method of the node, or a function that knows it; one may know names that are not bound yet."""
    client = node.create_client(Trigger, "ask")
    late: Any

    def told(_: object) -> Any:
        return node, late

    client.call_async(Trigger.Request()).add_done_callback(told)
    assert list(after_answers(client, node)) == [ANSWERED]
    late = client.call_async(Trigger.Request())
    late.add_done_callback(node.destroy_timer)
    assert list(after_answers(client, node)) == [ANSWERED, "destroy_timer"]


def test_a_call_that_is_lost_has_no_answer(node: Node) -> None:
    """So whoever waits for one is in no deadlock with who would take it, and keeps nothing waiting."""
    client, actions = node.create_client(Trigger, "ask"), ActionClient(node, Fibonacci, "count")
    client.call_async(Trigger.Request())
    actions.send_goal_async(Fibonacci.Goal())
    until(lambda: client.endpoint.inbox.items and internals_of(actions).goals.inbox.items)
    assert arrived(client) == arrived(actions) == ((), 0)


def test_the_callbacks_of_an_action_server(node: Node) -> None:
    """Also those that are registered later."""

    def accepted(goal: Any) -> None:
        """Do nothing."""

    server = ActionServer(node, Fibonacci, "fib", print)
    server.register_handle_accepted_callback(accepted)
    assert callbacks_of(server) == (print, accepted)
