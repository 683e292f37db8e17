"""Arguments that do not fit."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest
from example_interfaces.action import Fibonacci
from std_msgs.msg import Empty, String
from std_srvs.srv import Trigger

import rclpy
from rclpy.action import ActionClient, ActionServer
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.impl.mistakes.arguments import must_return
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from tests.cases import slow
from tests.rclpy.conftest import Spinner


class Lamp(Node):
    """Has callbacks."""

    def tick(self, *_: Any) -> None:
        """Be called."""


CALLS: list[tuple[Callable[[Any], Any], type[Exception], str]] = [
    (
        lambda n: n.create_publisher("chat", String, 10),
        AttributeError,
        "the arguments of create_publisher are in the wrong order: create_publisher(String, 'chat', 10)",
    ),
    (lambda n: n.create_publisher(String, 10, "chat"), TypeError, "create_publisher(String, 'chat', 10)"),
    (lambda n: n.create_publisher(String, "chat"), TypeError, "create_publisher needs qos_profile, too"),
    (
        lambda n: n.create_publisher("Strung", "chat", 10),
        AttributeError,
        "msg_type of create_publisher must be a message class, got 'Strung': write create_publisher(msg_type, topic, ",
    ),
    (
        lambda n: n.create_publisher("String", "chat", 10),
        AttributeError,
        "msg_type of create_publisher must be a message class, got 'String': write String, without quotes",
    ),
    (
        lambda n: n.create_publisher("std_msgs/msg/String", "chat", 10),
        AttributeError,
        "got 'std_msgs/msg/String': give the class: from std_msgs.msg import String",
    ),
    (
        lambda n: n.create_subscription(Trigger, "chat", n.tick, 10),
        RuntimeError,
        "got Trigger: Trigger is a service: use create_service or create_client",
    ),
    (
        lambda n: n.create_service(String, "chat", n.tick),
        RuntimeError,
        "String is a message: use create_publisher or create_subscription",
    ),
    (
        lambda n: n.create_service(Empty, "reset", n.tick),
        RuntimeError,
        "got Empty: write from std_srvs.srv import Empty",
    ),
    (lambda n: n.create_client(Fibonacci, "a"), RuntimeError, "Fibonacci is an action: use ActionServer or"),
    (
        lambda n: n.create_timer(1.0, n.tick, 10),
        AttributeError,
        "a timer has no depth: leave out 10, which is read as its callback group",
    ),
    (lambda n: n.create_subscription(String, "a", 10, n.tick), TypeError, "(String, 'a', self.tick, 10)"),
    (
        lambda n: n.create_subscription(String, "a", 10),
        TypeError,
        "create_subscription needs callback, too: create_subscription(String, 'a', callback, 10)",
    ),
    (
        lambda n: n.create_subscription(String, "a", None, 10),
        RuntimeError,
        "create_subscription was given None as its callback: pass the method itself, without parentheses",
    ),
    (lambda n: n.create_timer(n.tick, 1.0), TypeError, "create_timer(1.0, self.tick)"),
    (lambda n: n.create_service("a", Trigger, n.tick), AttributeError, "create_service(Trigger, 'a', self.tick)"),
    (lambda n: n.create_client("a", Trigger), AttributeError, "create_client(Trigger, 'a')"),
    (
        lambda n: ActionServer(n, "a", Fibonacci, n.tick),
        AttributeError,
        "ActionServer(self, Fibonacci, 'a', self.tick)",
    ),
    (lambda n: ActionClient(Fibonacci, n, "a"), AttributeError, "ActionClient(self, Fibonacci, 'a')"),
    (
        lambda n: n.set_parameters(Parameter("gain", value=3.0)),
        TypeError,
        "must be a list of parameters, got Parameter: write set_parameters([Parameter('name', value=...)])",
    ),
    (
        lambda _: Trigger(),
        NotImplementedError,
        "create a request with Trigger.Request() or a response with Trigger.Response()",
    ),
    (
        lambda _: Fibonacci(),
        NotImplementedError,
        "create a goal with Fibonacci.Goal() or a result with Fibonacci.Result()",
    ),
    (
        lambda n: n.create_client(Trigger, "a").call_async(Trigger.Request),
        TypeError,
        "got the class Trigger_Request: create a request with Trigger.Request()",
    ),
]


@slow
@pytest.mark.parametrize(("call", "kind", "text"), CALLS)
def test_a_call_says_how_it_is_written(
    node: Node, call: Callable[[Node], Any], kind: type[Exception], text: str
) -> None:
    """By an error of the class that ROS 2 raises."""
    with pytest.raises(kind, match=re.escape(text)):
        call(Lamp("lamp"))


@pytest.mark.parametrize(
    ("given", "text"),
    [
        (ReentrantCallbackGroup, "got the class ReentrantCallbackGroup: make one, as in ReentrantCallbackGroup()"),
        ("reentrant", "got 'reentrant': make one, as in MutuallyExclusiveCallbackGroup()"),
    ],
)
def test_what_is_no_callback_group(node: Any, given: object, text: str) -> None:
    """It is told what to make."""
    with pytest.raises((TypeError, AttributeError)) as caught:
        node.create_timer(1.0, print, callback_group=given)
    assert str(caught.value) == f"callback_group of create_timer must be a callback group, {text}"


def test_other_faults_keep_their_words(node: Node) -> None:
    """Where every argument is of the right kind, the error is ROS 2's."""
    with pytest.raises(TypeError, match="unexpected keyword argument 'colour'"):
        node.create_publisher(String, "chat", 10, colour=1)  # type: ignore[call-arg]
    with pytest.raises(ValueError, match="history depth must be"):
        node.create_publisher(String, "chat", -1)


@pytest.mark.parametrize("what", ["create_timer", "create_service", "add_on_set_parameters_callback"])
def test_no_callback_where_ros_takes_it(node: Node, caplog: pytest.LogCaptureFixture, what: str) -> None:
    """It is told with the line; a rate, which has none, is not."""
    arguments: dict[str, tuple[Any, ...]] = {"create_timer": (1.0, None), "create_service": (Trigger, "a", None)}
    getattr(node, what)(*arguments.get(what, (None,)))
    node.create_rate(1.0)
    [text] = [record.getMessage() for record in caplog.records if "callback" in record.getMessage()]
    assert text.startswith(f"{what} was given None as its callback: pass the method itself")
    assert re.search(r"\(test_arguments\.py:\d+\)$", text)


@slow
@pytest.mark.parametrize("value", [False, 3])
@pytest.mark.parametrize("what", ["create_timer", "create_service", "create_subscription"])
def test_an_attribute_that_hides_the_callback(node: Node, what: str, value: object) -> None:
    """The call is refused, with the method's line; ROS 2 fails when it calls the callback."""
    lamp: Any = Lamp("lamp")
    lamp.tick = value
    given = {"create_timer": (1.0, value), "create_service": (Trigger, "a", value)}
    with pytest.raises((TypeError, RuntimeError)) as caught:
        getattr(lamp, what)(*given.get(what, (String, "a", value, 10)))
    text = str(caught.value)
    assert text.startswith(f"{what} was given self.tick, which is {value!r} and hides the method tick (test_arguments")
    assert text.endswith("give the attribute or the method another name")


def test_a_callback_that_is_no_function(node: Node) -> None:
    """It is refused where it is given."""
    with pytest.raises(TypeError, match="create_timer was given 'tick' as its callback: pass the method itself"):
        node.create_timer(1.0, "tick")  # type: ignore[arg-type]


def test_a_policy_where_a_depth_belongs(node: Node, caplog: pytest.LogCaptureFixture) -> None:
    """It is told what the number means; ROS 2 takes it."""
    node.create_publisher(String, "chat", ReliabilityPolicy.BEST_EFFORT)
    node.create_publisher(String, "chat", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
    [text] = [record.getMessage() for record in caplog.records]
    assert text.startswith("create_publisher takes ReliabilityPolicy.BEST_EFFORT for a depth of 2: write QoSProfile(")
    assert re.search(r"\(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT\) \(test_arguments\.py:\d+\)$", text)


class NotConstructed(Node):
    """Is no node."""

    def __init__(self) -> None:
        self.create_timer(1.0, print)


class Left(Node):
    """Is no node either."""

    def __init__(self) -> None:
        self.count = 0


def test_a_node_whose_init_was_not_called(node: Node) -> None:
    """Says so, with the line where that is missing, whatever is done with it first."""
    uses: list[tuple[type[Node], Callable[[], Any]]] = [
        (NotConstructed, NotConstructed),
        (Left, lambda: rclpy.spin(Left())),
        (Left, lambda: Left().get_logger()),
    ]
    for cls, use in uses:
        line = cls.__init__.__code__.co_firstlineno
        text = f"{cls.__name__}.__init__ (test_arguments.py:{line}) must call super().__init__('node_name')"
        with pytest.raises(AttributeError, match=re.escape(text)):
            use()


def test_callbacks_that_must_return_something(node: Node, spin: Spinner) -> None:
    """Are named with their line; an object that can be called, by its class."""

    def forget(*_: Any) -> None:
        """Return nothing."""

    place = f"forget (test_arguments.py:{forget.__code__.co_firstlineno}) must return "
    node.create_service(Trigger, "a", forget)
    node.create_client(Trigger, "a").call_async(Trigger.Request())
    with pytest.raises(TypeError, match=re.escape(f"{place}its response, and returned None")):
        spin(lambda: False)
    node.declare_parameter("level", 1)
    node.add_on_set_parameters_callback(forget)
    with pytest.raises(AttributeError, match=re.escape(f"{place}SetParametersResult(successful=True)")):
        node.set_parameters([Parameter("level", value=2)])
    assert must_return(node, "it", 3) == "Node must return it, and returned int"
    told = must_return(node, "its response", Trigger.Response)
    assert told == "Node must return its response, and returned the class Trigger.Response: write Trigger.Response()"


def test_an_action_that_returns_no_result(node: Node, spin: Spinner) -> None:
    """Is named, and its error leaves the executor."""

    def execute(goal: Any) -> None:
        goal.succeed()

    server, client = ActionServer(node, Fibonacci, "count", execute), ActionClient(node, Fibonacci, "count")
    with server, client:
        client.send_goal_async(Fibonacci.Goal(order=1)).add_done_callback(lambda f: f.result().get_result_async())
        with pytest.raises(AssertionError, match=r"execute \(test_arguments.py:\d+\) must return a Fibonacci.Result"):
            spin(lambda: False)
