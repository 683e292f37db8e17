"""Goals that pile up."""

from __future__ import annotations

import inspect

import pytest
from example_interfaces.action import Fibonacci

from rclpy.action import ActionClient, ActionServer
from rclpy.impl.mistakes.unended_goals import MANY
from rclpy.node import Node
from tests.rclpy.conftest import Spinner

Caplog = pytest.LogCaptureFixture


def told(caplog: Caplog) -> list[str]:
    return [text for text in caplog.messages if "sends another goal" in text]


def test_goals_of_a_timer(node: Node, spin: Spinner, caplog: Caplog) -> None:
    """They are reported once, with the line that sends them."""
    server = ActionServer(node, Fibonacci, "count", lambda _: None, handle_accepted_callback=lambda _: None)
    client = ActionClient(node, Fibonacci, "count")
    assert client.wait_for_server(5.0)
    sent = []

    def tick() -> None:
        sent.append(client.send_goal_async(Fibonacci.Goal(order=3)))

    node.create_timer(0.001, tick)
    spin(lambda: len(sent) > MANY + 5)
    server.destroy()
    line = inspect.getsourcelines(tick)[1] + 1
    assert told(caplog) == [
        f"test_unended_goals.py:{line}: this sends another goal to /count while 10 wait or run: send the next one when "
        "the result of the former has come, or cancel the former with goal_handle.cancel_goal_async()"
    ]


def test_goals_of_a_program(node: Node, caplog: Caplog) -> None:
    """Goals that a program sends outside callbacks end."""
    client = ActionClient(node, Fibonacci, "count")
    for _ in range(MANY + 5):
        client.send_goal_async(Fibonacci.Goal())
    assert told(caplog) == []
