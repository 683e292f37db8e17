"""Next steps for errors about calls."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from message_filters import SimpleFilter
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String
from tf2_ros import TransformListener

import rclpy
from graphflow.rclpy.hints import lookup
from rclpy.action import ActionClient, ActionServer
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from tests.cases import slow
from tests.rclpy.hinted import hint_of


class Selfless:
    """Is written without `self`."""

    def __init__() -> None:  # type: ignore[misc]
        """Fail."""


SELFLESS: Any = Selfless
SUPER: Any = super
LISTENER: Any = TransformListener
EXECUTOR: Any = SingleThreadedExecutor(context=Context())
MISTAKES: list[tuple[Callable[[Any], Any], str]] = [
    (
        lambda n: n.create_service(AddTwoInts, "add", n.tick, 10),
        "leave out 10, it is called as create_service(",
    ),
    (
        lambda n: n.create_timer(hz=10, callback=print),
        "in seconds: create_timer(1.0 / 10, callback)",
    ),
    (lambda n: n.create_timer(1.0, print, colour=1), "it is called as create_timer(timer_period_sec, callback, "),
    (lambda n: LISTENER(None), "it is called as TransformListener(buffer, node, "),
    (lambda n: SUPER.__init__("node"), "super is called: write super().__init__('node_name')"),
    (lambda n: rclpy.task.Future().add_done_callback(n.tick()), "without parentheses: n.tick"),
    (lambda n: n.tick(), ""),
    (lambda n: SELFLESS(), "self is missing: write def __init__(self):"),
    (lambda n: EXECUTOR.spin(n), "executor.add_node(node), and then executor.spin()"),
]


class Ticking(Node):
    """Has a callback."""

    def tick(self, future: Any) -> None:
        """Be called."""


@pytest.mark.parametrize(("wrong", "sentence"), MISTAKES)
def test_calls_of_rclpy(node: Node, wrong: Callable[[Any], Any], sentence: str) -> None:
    """Each is answered with how it is written."""
    found = hint_of(lambda: wrong(Ticking("ticking")))
    assert sentence in found if sentence else found == ""


class Wrong(Node):
    """Its callbacks take too few arguments."""

    def __init__(self) -> None:
        super().__init__("wrong")

    def none(self) -> None:
        """Take nothing."""

    def one(self, request: Any) -> None:
        """Take one."""

    def bare() -> None:  # type: ignore[misc]
        """Take not even self."""

    def check(self) -> SetParametersResult:
        """Take nothing."""


CALLBACKS: list[tuple[Callable[[Any], Any], str, str]] = [
    (lambda n: n.create_timer(0.0, n.bare), "bare", "(): def bare(self)"),
    (lambda n: n.create_timer(0.0, lambda one, two: None), "the lambda of", "(timer_info): lambda timer_info: ..."),
    (lambda n: n.create_subscription(String, "chat", n.none, 1), "none", "(message): def none(self, message)"),
    (lambda n: ask(n, n.one), "one", "(request, response): def one(self, request, response)"),
    (lambda n: send(n, n.none), "none", "(goal_handle): def none(self, goal_handle)"),
    (lambda n: done(n, n.none), "none", "(future): def none(self, future)"),
    (lambda n: matched(n), "none", "(string, string): def none(self, string, string)"),
    (lambda n: checked(n), "check", "(parameters): def check(self, parameters)"),
]


def ask(node: Node, callback: Any) -> None:
    node.create_service(AddTwoInts, "add", callback)
    node.create_client(AddTwoInts, "add").call_async(AddTwoInts.Request())


def send(node: Node, callback: Any) -> None:
    ActionServer(node, Fibonacci, "fib", execute_callback=callback)
    ActionClient(node, Fibonacci, "fib").send_goal_async(Fibonacci.Goal())


def done(node: Node, callback: Any) -> None:
    node.create_service(AddTwoInts, "add", lambda request, response: response)
    node.create_client(AddTwoInts, "add").call_async(AddTwoInts.Request()).add_done_callback(callback)


def matched(node: Any) -> None:
    both = SimpleFilter()
    both.registerCallback(node.none)
    both.signalMessage(String(), String())


def checked(node: Any) -> None:
    node.declare_parameter("n", 1)
    node.add_on_set_parameters_callback(node.check)
    node.set_parameters([Parameter("n", value=2)])


@slow
@pytest.mark.parametrize(("make", "who", "how"), CALLBACKS)
def test_callbacks_that_take_other_arguments(
    network: Any, capfd: pytest.CaptureFixture[str], make: Callable[[Any], Any], who: str, how: str
) -> None:
    """Named with their line and what they are called with."""
    rclpy.init()
    node = Wrong()
    timer = threading.Timer(5.0, rclpy.try_shutdown)
    timer.start()

    def run() -> None:
        make(node)
        rclpy.spin(node)

    found = ""
    try:
        run()
    except Exception as error:
        if not isinstance(error, (ExternalShutdownException, AssertionError)):
            found = lookup.hint(error)
    finally:
        timer.cancel()
    found = found or capfd.readouterr().err  # of actions: it is in the log
    assert who in found
    assert f"is called with {how}" in found
    assert "test_calls.py:" in found


def test_a_service_that_returns_no_response(node: Node) -> None:
    """It was called as it should be."""

    def run() -> None:
        ask(node, lambda request, response: 1)
        rclpy.spin(node)

    assert hint_of(run) == "set the fields of response, and return response"


class Handle:
    """Has a property, and a value that is a text."""

    is_cancel_requested = False

    def __init__(self) -> None:
        self.name = "x"


@pytest.mark.parametrize(
    ("line", "way"),
    [
        ("pub(String())", "write pub.publish(msg)"),
        ("n.client(AddTwoInts.Request())", "write n.client.call_async(request)"),
        ("[pub][0](String())", ""),
    ],
)
def test_objects_that_are_called(tmp_path: Path, node: Node, line: str, way: str) -> None:
    """The method that is meant is named."""
    file = tmp_path / "wrong.py"
    file.write_text(line)
    holder: Any = type("Holder", (), {})()
    holder.client = node.create_client(AddTwoInts, "add")
    known = {"pub": node.create_publisher(String, "chat", 10), "n": holder, "String": String, "AddTwoInts": AddTwoInts}
    assert hint_of(lambda: exec(compile(line, str(file), "exec"), known)) == way


@pytest.mark.parametrize(
    ("line", "path"),
    [
        ("handle.is_cancel_requested()", "handle.is_cancel_requested"),
        ("print(param.value(), str(handle))", "param.value"),
        ("given('n').value()", "value"),
        ("qos()", "qos"),
        ("print(str()); handle.name()", "handle.name"),
        ("handle.name(3)", ""),
    ],
)
def test_values_that_are_called(tmp_path: Path, line: str, path: str) -> None:
    """The one of the line is named."""
    file = tmp_path / "wrong.py"
    file.write_text(line)
    known: dict[str, Any] = {"handle": Handle(), "param": Parameter("n", value=1.5), "qos": QoSProfile(depth=1)}
    known |= {"given": lambda name: Parameter(name, value=1.5), "print": str}
    found = hint_of(lambda: exec(compile(line, str(file), "exec"), known))
    assert found == (f"{path} is not a function: remove the parentheses after it" if path else "")
