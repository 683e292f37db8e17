"""The next step for errors of programs."""

from __future__ import annotations

import asyncio
import math
import sys
from collections.abc import Callable
from typing import Any

import pytest
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from geometry_msgs.msg import Twist
from std_msgs.msg import Header, String

import rclpy
from graphflow.rclpy.hints import lookup, tracebacks
from rclpy.action.client import ClientGoalHandle
from rclpy.action.server import ServerGoalHandle
from rclpy.clock import Clock
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rclpy.timer import TimerInfo
from tests.rclpy.hinted import hint_of

ROS: Any = rclpy


def spin_once(wrong: int) -> None:
    """Be a function of the user's that is called as one of rclpy's."""


OWN: Any = spin_once
NOW = Clock().now()
NUMBERS = [1.0, 2.0, 3.0]
TICK: Any = TimerInfo.__new__(TimerInfo)
MAKER: Any = MultiThreadedExecutor
PROFILE: Any = QoSProfile
TIME: Any = rclpy.time.Time
WRONG: list[tuple[Callable[[Any], Any], str]] = [
    # by attribute
    (lambda n: n.get_logger.info("hi"), "get_logger is a method: write get_logger().info(...)"),
    (lambda n: n.create_timer(1.0, print).stop(), "a timer is stopped by timer.cancel(), and started again by"),
    (lambda n: n.get_clock().now().seconds, "write .nanoseconds / 1e9"),
    (lambda n: n.create_action_server(Fibonacci, "fib", print), 'write ActionServer(self, Type, "name", self.execute)'),
    (lambda n: n.get_logger().warning_once("hi"), "once is an argument: get_logger().info(..., once=True)"),
    (
        lambda n: n.create_client(AddTwoInts, "add").call_async(AddTwoInts.Request()).sum,
        "it is in the answer: future.res",
    ),
    (
        lambda n: n.create_client(AddTwoInts, "add").call_async(AddTwoInts.Request()).result().sum,
        "future.result() is None until the future is done",
    ),
    (
        lambda n: n.get_clock().now() - n.header.stamp,
        "n.header.stamp is a message: write rclpy.time.Time.from_msg(n.header.stamp)",
    ),
    (lambda n: NOW - n.header.stamp, "n.header.stamp is a message: write rclpy.time.Time.from_msg"),
    (lambda n: n.header.stamp < n.get_clock().now(), "write rclpy.time.Time.from_msg(n.header.stamp)"),
    (lambda n: n.get_clock().now() - [n.header][0].stamp, "one of them is a message: rclpy.time.Time.from_msg(stamp)"),
    (lambda n: Imu(), "write from sensor_msgs.msg import Imu"),  # type: ignore[name-defined]  # noqa: F821
    # by text
    (lambda n: setattr(n, "timers", 1), "every node has 'timers' already: choose another name for the attribute"),
    (lambda n: setattr(n, "handle", 1), "every node has 'handle' already"),
    (lambda n: asyncio.get_running_loop(), "callbacks of rclpy run without asyncio"),
    (
        lambda n: n.get_clock().now() - n.get_clock().now() > 1.0,
        "the difference is a Duration: write (n.get_clock().now() - n.get_clock().now()).nanoseconds / 1e9",
    ),
    (
        lambda n: n.get_clock().now() - NOW.nanoseconds / 1e9,
        "the difference is a Duration: write (n.get_clock().now() - NOW).nanoseconds / 1e9",
    ),
    (lambda n: NOW > 1.0, "use the seconds of a time or duration: .nanoseconds / 1e9"),  # type: ignore[operator]
    (lambda n: (NOW.nanoseconds / 1e9) ^ 2, "a power is written with **"),  # type: ignore[operator]
    (lambda n: min(NUMBERS[-1:1]), "NUMBERS[-1:1] is empty, since slices do not wrap: write ["),
    (lambda n: 2.0 * TICK, "a timer calls a callback that has an argument with a TimerInfo: leave the argument out"),
    (lambda n: math.sin(TICK), "a timer calls a callback that has an argument with a TimerInfo"),
    (lambda n: float(TICK), "a timer calls a callback that has an argument with a TimerInfo"),
    (lambda n: TICK < 2.0, "a timer calls a callback that has an argument with a TimerInfo"),
    (lambda n: TICK.get_logger(), "a timer calls a callback that has an argument with a TimerInfo"),
    (
        lambda n: setattr(n.header.stamp, "sec", TICK),
        "leave the argument out, or give it a value by functools.partial(self.callback, value)",
    ),
    (lambda n: 1 / n.declare_parameter("rate", 1.0), "a parameter's value is in .value"),
    (lambda n: Parameter("rate", Parameter.Type.DOUBLE, 2), "a DOUBLE is a float: write 2.0"),
    (lambda n: n.declare_parameter("rate", float), "or a type as in declare_parameter('name', Parameter.Type.DOUBLE)"),
    (
        lambda n: n.declare_parameter("gains", {"p": 1.0}),
        "declare a parameter for each key: declare_parameters(",
    ),
    (
        lambda n: n.declare_parameter("gains", object()),
        "a parameter is a bool, an int, a float, a str, bytes, or a list",
    ),
    (lambda n: n.declare_parameter("gains", [1, 2.5]), "all elements must be of one type, as in [1.0, 2.5]"),
    (lambda n: n.declare_parameters("", [("speed")]), "('speed') is a string, not a tuple: write ('speed', 1.0)"),
    (lambda n: n.declare_parameters("", ["max"]), "('max') is a string, not a tuple: write ('max', 1.0)"),
    (lambda n: n.declare_parameters("", [("a", 1, 2, 3)]), ""),
    (lambda n: n.declare_parameter("rate", 1.0, "the rate"), "is a ParameterDescriptor(description='the rate')"),
    (lambda n: n.set_parameters(Parameter("n", value=6)), ""),
    (lambda n: Parameter("n", 2.0), "pass the value by keyword: Parameter('name', value=2.0)"),  # type: ignore[arg-type]
    (lambda n: [Parameter("n", value=6)].name, "that is a list of parameters: for parameter in parameters"),  # type: ignore[attr-defined]
    (lambda n: n.set_parameters({"n": 6}), "write set_parameters([Parameter('name', value=6)])"),
    (lambda n: n.create_publisher(String, "chat", 1).publish(String), "that is a class, not a message: write String()"),
    (lambda n: n.create_publisher(String, "chat", 1).publish("hel" + "lo"), "write String(data='hel' + 'lo')"),
    (lambda n: Imu(), "write from sensor_msgs.msg import Imu"),  # type: ignore[name-defined]  # noqa: F821
    (lambda n: n.create_timer(n.declare_parameter("rate", 1.0), print), "a parameter's value is in .value"),
    (lambda n: (n.destroy_node(), n.get_name()), "it was already destroyed, by itself or with its node"),
    (lambda n: rclpy.init(), "call rclpy.init() once, before the first node is created"),
    # fields
    (lambda n: String().text, "String has data"),
    (lambda n: setattr(n.twist, "linaer", 1), "Twist has linear, angular; did you mean 'linear'?"),
    (lambda n: Twist(x=1.0), "it is in a nested message: .linear.x"),
    (lambda n: Fibonacci.Impl.FeedbackMessage().sequence, "it is in a nested message: .feedback.sequence"),
    (lambda n: String("hi"), "fields are keyword arguments: String(data=...)"),
    # calls
    (lambda n: type(n)("other", "space"), "write super().__init__('node_name', namespace='...') in the __init__"),
    (lambda n: n.get_logger().info("%d", 1), "pass one text: get_logger().info(f'... {value}')"),
    (lambda n: n.create_client(AddTwoInts, "add").wait_for_service(timeout=1.0), "it is timeout_sec="),
    (
        lambda n: ROS.spin_until_future_complete(n),
        "spin_until_future_complete(node, future, executor=, timeout_sec=)",
    ),
    (lambda n: QoSProfile(reliability=1), "give it a depth: QoSProfile(depth=10, ...)"),
    (lambda n: PROFILE(10), "pass policies by keyword: QoSProfile(depth=10, reliability="),
    (lambda n: n.declare_parameters([("a", 1)]), "write declare_parameters('', [('a', 1), ('b', 2)])"),
    (lambda n: ROS.init(["x"]), "write rclpy.init(), or rclpy.init(args=sys.argv)"),
    (lambda n: MAKER.add_node(n), "MultiThreadedExecutor is a class: create an instance, MultiThreadedExecutor()"),
    (lambda n: MAKER.shutdown(), "MultiThreadedExecutor is a class: create an instance, MultiThreadedExecutor()"),
    (lambda n: n.get_logger().info("a", throttle=1.0), "throttle_duration_sec=1.0"),
    (lambda n: n.get_logger().set_level("debug"), "write LoggingSeverity.DEBUG, from rclpy.logging"),
    (lambda n: n.get_logger().set_level("warning"), "write LoggingSeverity.WARN, from rclpy.logging"),
    (lambda n: n.get_logger().set_level("loud"), "write LoggingSeverity.INFO, from rclpy.logging"),
    (lambda n: TIME.from_msg(Twist()), "pass a message's stamp: Time.from_msg(msg.header.stamp)"),
    (
        lambda n: n.create_client(AddTwoInts, "add").call_async(AddTwoInts.Request(), print),
        "it takes one request, as in call_async(AddTwoInts.Request(a=1, b=2)); a callback goes to the future",
    ),
    (lambda n: TIME(seconds=1).to_msg().to_sec(), "it is a message; write Time.from_msg(...).nanoseconds / 1e9"),
    (lambda n: setattr(TIME(seconds=1).to_msg(), "sec", 0.5), "write sec=0, nanosec=500_000_000"),
    (lambda n: setattr(n.declare_parameter("m", 1), "value", 2), "a Parameter is a copy; the node's own is set by"),
    # nothing to add
    (lambda n: int("a"), ""),
    (lambda n: OWN(), ""),
    (lambda n: n.nothing, ""),
]


@pytest.mark.parametrize(("wrong", "sentence"), WRONG)
def test_mistakes(node: Any, wrong: Callable[[Any], Any], sentence: str) -> None:
    """Each has its sentence."""
    node.twist, node.header = Twist(), Header()
    found = hint_of(lambda: wrong(node))
    assert sentence in found if sentence else found == ""


def test_attributes_that_are_set(node: Node) -> None:
    """Before Python 3.13 these errors do not know their object: it is found in the user's own code."""

    def set_one() -> None:
        profile = QoSProfile(depth=1)
        profile.reliabilty = 1  # type: ignore[attr-defined]

    assert hint_of(set_one) == "did you mean 'reliability'?"


def test_the_note(node: Node) -> None:
    """It is added once; the lines of graphflow's are left out then."""

    def tick() -> None:
        node.create_publisher(String, "chat", 1).publish(String)

    node.create_timer(0.0, tick)
    with pytest.raises(TypeError) as caught:
        rclpy.spin(node)
    for _ in range(2):
        tracebacks.shorten(caught.value)
        assert caught.value.__notes__ == ["note: that is a class, not a message: write String()"]


def test_goals(node: Node) -> None:
    """Their fields are in the request."""
    goal: Any = ServerGoalHandle.__new__(ServerGoalHandle)
    assert hint_of(lambda: goal.order) == "it is in the goal: goal_handle.request.order"


def test_clocks_have_no_hint_of_nodes() -> None:
    """A name that another class has is no reason for a hint."""
    clock: Any = Clock()
    assert hint_of(lambda: clock.publish()) == ""


class Task:
    """A class of the program's with the name of one of rclpy's."""

    name = "mow"


class Timer:
    """Another."""


class Lazy:
    """An object whose attributes cannot be looked at."""

    def __getattribute__(self, name: str) -> Any:
        raise LookupError(name)


class Wordless(Exception):
    """An error without a text."""

    def __str__(self) -> str:
        raise ValueError("no text")


@pytest.mark.parametrize(("thing", "attribute"), [(Task(), "nme"), (Timer(), "start")])
def test_a_class_of_the_programs_own(thing: Any, attribute: str) -> None:
    """Gets no advice on a class of rclpy's that has the same name."""
    with pytest.raises(AttributeError) as caught:
        getattr(thing, attribute)
    assert lookup.hint(caught.value) == ""


def test_an_error_that_cannot_be_looked_at() -> None:
    """Has no hint, and is shown all the same."""
    thing = Lazy()
    with pytest.raises(AttributeError) as caught:
        raise AttributeError("'Foo' object has no attribute 'bar'")
    assert (lookup.hint(caught.value), lookup.hint(Wordless())) == ("", "")
    del thing


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("delta", "future.result().result.delta"),
        ("result", "future.result().result"),
        ("acepted", "did you mean 'accepted'?"),
    ],
)
def test_a_field_of_the_result_in_the_handle(name: str, sentence: str) -> None:
    """The handle has no result's fields; the way to the result is told, and the attribute that is almost meant."""
    handle = ClientGoalHandle.__new__(ClientGoalHandle)

    class Asker:
        def read(self) -> object:
            return getattr(handle, name)

    start = "" if sentence.endswith("?") else "this is the goal's handle, and the result comes later: "
    asking = "goal_handle.get_result_async().add_done_callback(self.on_result)"
    moved = "what uses the result, and rclpy.shutdown(), moves into a new method on_result(self, future), where it is "
    later = f"{asking}; {moved}" if start else ""
    assert hint_of(Asker().read) == f"{start}{later}{sentence}"
    spun = "result_future = goal_handle.get_result_async(), rclpy.spin_until_future_complete(node, result_future)"
    expected = f"{start}{spun}, result_{sentence}" if start else sentence
    assert hint_of(lambda: getattr(handle, name)) == expected  # in a function of the program's


def test_an_argument_that_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    """The number of those that the program was given is told; of other lists, that of their values."""
    monkeypatch.setattr(sys, "argv", ["add_client", "2"])
    assert hint_of(lambda: sys.argv[2]).startswith("the program was given 1 argument: write more behind its name")
    assert hint_of(lambda: NUMBERS[5]) == "NUMBERS has 3 values, [0] to [2]"


class Early(Node):
    """A node that calls its callback where it should pass it."""

    def __init__(self) -> None:
        super().__init__("early")
        self.create_timer(0.5, self.tick())  # type: ignore[func-returns-value]
        self.count = 0

    def tick(self) -> None:
        """Fail, since `count` comes later."""
        self.count += 1


def test_a_callback_that_is_called(node: Any) -> None:
    """The line of the call is explained, not the missing attribute."""
    text = "create_timer(..., self.tick()) calls tick at once, and passes on its result, None; write self.tick"
    assert hint_of(Early) == text
