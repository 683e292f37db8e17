"""The words of rclpy and what they are called here: one table for error messages and for the page "coming from ROS 2".

`python -m graphflow.runtime.mistakes.rclpy_words` prints the table of that page.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from functools import cache, wraps
from typing import Any, ClassVar, Literal, NamedTuple, ParamSpec, Self, TypeVar

from graphflow.errors import DeclarationError
from graphflow.names import nearest
from graphflow.runtime.call_site import here

P = ParamSpec("P")
T = TypeVar("T")


class Word(NamedTuple):
    """One row.

    Attributes:
        ros: How it is written with rclpy.
        here: How it is written with graphflow.
        attributes: Attributes of rclpy's objects that ours do not have: who uses them is told `here`.
        keywords: Keywords of rclpy's calls, likewise.
        names: Names that are imported from rclpy, likewise.
    """

    ros: str
    here: str
    attributes: str = ""
    keywords: str = ""
    names: str = ""


WORDS = (
    Word(
        "`rclpy.init`, `spin`, `shutdown`",
        "`graphflow.run(Talker)`; in your own program `async with graphflow.running(node):`",
        names="init spin shutdown ok try_shutdown create_node",
    ),
    Word(
        "`spin_once`, `spin_until_future_complete`",
        "not needed: `await`",
        "executor",
        names="spin_once spin_until_future_complete",
    ),
    Word('`super().__init__("talker")`', "the same, or leave it out: the name is then the class's in snake case"),
    Word("`from std_msgs.msg import String`", "`from graphflow.msgs.std_msgs.msg import String`"),
    Word('`create_publisher(String, "chatter", 10)`', 'the same, or `chatter = Publisher(String, "chatter", 10)`'),
    Word(
        '`create_subscription(String, "chatter", self.heard, 10)`',
        'the same, or `@subscription(String, "chatter", 10)`',
        names="subscriber Subscriber",
    ),
    Word("`create_timer(1.0, self.tick)`", "the same, or `@timer(1.0)`, `@timer(hz=rate)`"),
    Word(
        '`create_service(Srv, "name", self.answer)`',
        'the same, or `@service(Srv, "name")`; the handler takes `(request)` or `(request, response)`',
    ),
    Word('`create_client(Srv, "name")`', 'the same, or `Client(Srv, "name")`'),
    Word("`client.call_async(request)`, then spin", "`await client.call(request, timeout=2.0)`", "call_async"),
    Word("`client.call(request)`", "the same with `await`; the rest of the node keeps running"),
    Word(
        "`client.wait_for_service(1.0)`",
        "`await client.wait_ready(1.0)`, which returns True or False",
        "wait_for_service wait_for_server",
    ),
    Word("`client.service_is_ready()`", "the same"),
    Word("`future.add_done_callback(f)`", "the lines after the `await`"),
    Word(
        '`declare_parameter("rate", 1.0)`',
        '`rate = Param(1.0)`, then `self.rate`; `self.declare_parameter("rate", 1.0)` returns a copy of the value: '
        'where it is used, read `self.parameters.get("rate")`',
    ),
    Word(
        "`declare_parameters(ns, [...])`",
        "a `Param` for each in the class, or `self.declare_parameter` for each",
        "declare_parameters",
    ),
    Word(
        '`get_parameter("rate").value`',
        '`self.parameters.get("rate")`; `self.rate` where the class has `rate = Param(1.0)`',
        "get_parameter get_parameters get_parameter_or get_parameters_by_prefix get_parameter_type get_parameter_types",
    ),
    Word('`has_parameter("rate")`', '`"rate" in self.parameters`', "has_parameter"),
    Word(
        "`set_parameters([...])`",
        '`self.rate = 2.0`, or `self.parameters.set({"rate": 2.0})`',
        "set_parameters set_parameters_atomically",
    ),
    Word("`describe_parameter(name)`", "`self.parameters.describe(name)`", "describe_parameter describe_parameters"),
    Word(
        "`add_on_set_parameters_callback`",
        "limits in `Param`, or a method with `@rate.check`; for several at once `self.parameters.check(f)`",
        "add_on_set_parameters_callback add_pre_set_parameters_callback set_parameters_callback",
    ),
    Word(
        "`add_post_set_parameters_callback`",
        "a method with `@rate.on_change`, or `self.parameters.observe(f)`",
        "add_post_set_parameters_callback",
    ),
    Word(
        "`ParameterDescriptor`, ranges",
        '`Param(1.0, ge=0.0, le=5.0, step=0.5, doc="...", read_only=True)`; `declare_parameter` takes them too',
        keywords="descriptor min max",
        names="ParameterDescriptor",
    ),
    Word("`dynamic_typing=True`", '`self.declare_parameter("name", 1, dynamic=True)`'),
    Word("`undeclare_parameter`", "the same"),
    Word("a callback with `(msg, info)`", "a method with a third argument, `info: MessageInfo`"),
    Word("`ignore_local_publications`", "`ignore_local=True`"),
    Word('`get_logger().info("...")`', '`self.log.info("...")`, a Python logger', "get_logger"),
    Word(
        "`get_logger().info(..., throttle_duration_sec=1.0)`, `once=True`",
        '`self.log.info("...", throttle=1.0)`, `once=True`',
    ),
    Word(
        "`get_clock().now()`",
        "`self.clock.now()`; no `.to_msg()`, since a `Time` can be put into a message",
        "get_clock",
    ),
    Word("`now().to_msg()`", "the `Time` itself, which can be put into a message", "to_msg"),
    Word("`now().nanoseconds`", "the same; `.seconds` as a float"),
    Word("`Duration(seconds=1.0)`", "`Duration.of(1.0)`"),
    Word("`create_rate(10).sleep()`", "`async for n in self.clock.every(hz=10.0):`", "create_rate", names="Rate"),
    Word("`create_guard_condition`", "an `asyncio.Event` that a `@task` awaits", "create_guard_condition"),
    Word(
        "`get_name()`, `get_namespace()`, `get_fully_qualified_name()`",
        "`node.name`, `node.namespace`, `node.full_name`",
        "get_name get_namespace get_fully_qualified_name",
    ),
    Word(
        "`get_topic_names_and_types()`, `get_node_names()`",
        "`self.context.cache.topics()`, `.nodes()`, `.services()`, `.actions()`",
        "get_topic_names_and_types get_service_names_and_types get_node_names get_node_names_and_namespaces"
        " get_publishers_info_by_topic get_subscriptions_info_by_topic count_publishers count_subscribers",
    ),
    Word("`publisher.get_subscription_count()`", "the same"),
    Word("`publisher.topic_name`, `client.srv_name`", "`.name`", "topic topic_name srv_name service_name"),
    Word(
        "`QoSProfile(depth=1, durability=...)`, `qos_profile=`",
        "`Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)`, `qos=`",
        keywords="qos_profile",
        names="QoSProfile",
    ),
    Word(
        "`MutuallyExclusiveCallbackGroup()`",
        "`Group(1)`; a class's `default_group = Group(1)` is rclpy's default",
        "default_callback_group",
        names="MutuallyExclusiveCallbackGroup",
    ),
    Word("`ReentrantCallbackGroup()`", "`Group(None)`", names="ReentrantCallbackGroup CallbackGroup"),
    Word("`callback_group=`", "`group=`, with a `Group` of the class", keywords="callback_group"),
    Word(
        "`SingleThreadedExecutor`, `MultiThreadedExecutor`",
        "one event loop per process; `thread=True` and `await self.offload(f)` for code that blocks",
        names="SingleThreadedExecutor MultiThreadedExecutor",
    ),
    Word(
        "`destroy_publisher(p)` and so on",
        "`p.close()`",
        "destroy_publisher destroy_subscription destroy_client destroy_service destroy_timer destroy_rate destroy",
    ),
    Word(
        "`destroy_node()`",
        "not needed: done at the end of `run` or `running`; `self.shutdown()` ends the node from within",
        "destroy_node",
    ),
    Word(
        '`ActionServer(node, Type, "name", execute)`',
        '`@action(Type, "name")` on the method, or `self.create_action_server(Type, "name", self.execute)`',
        keywords="execute_callback",
    ),
    Word(
        "`goal_callback=`, `GoalResponse.REJECT`",
        "`accept=`, a method that returns True, False, or a text that says why not, for the client",
        keywords="goal_callback",
        names="GoalResponse",
    ),
    Word(
        "`cancel_callback=`, `CancelResponse.REJECT`",
        "`cancellable=`: True, False, or a method that takes the goal and decides",
        keywords="cancel_callback",
        names="CancelResponse",
    ),
    Word(
        "`handle_accepted_callback=`, `goal_handle.execute()`",
        "`policy=`: `reject`, `queue`, `preempt` or `parallel`",
        "execute",
        keywords="handle_accepted_callback",
    ),
    Word(
        '`ActionClient(node, Type, "name")`',
        '`ActionClient(Type, "name")`, then `async with self.client.send(goal) as sent:`',
    ),
    Word(
        "`send_goal_async(goal)`, `get_result_async()`",
        "`async with client.send(goal) as sent:`, then `await sent.result()`",
        "send_goal_async get_result_async get_result",
    ),
    Word("`cancel_goal_async()`", "`await sent.cancel()`", "cancel_goal_async cancel_goal"),
    Word("`ServerGoalHandle`, `ClientGoalHandle`", "the same; a handler's argument is annotated `Type.Handle`"),
    Word("`goal_handle.publish_feedback(f)`", "`goal.feedback(f)`", "publish_feedback"),
    Word("`goal_handle.is_cancel_requested`", "the same; and cancelling raises `CancelledError` at an `await`"),
    Word("`goal_handle.succeed()`", "return the result", "succeed"),
    Word("`goal_handle.abort()`", "`raise Abort(reason)`", "abort"),
    Word("`goal_handle.canceled()`", "let `CancelledError` pass; `goal.partial` is the result", "canceled"),
    Word(
        "`LifecycleNode`, `on_configure(self, state)`",
        "`LifecycleNode`, `async def on_configure(self)`; it succeeds by returning nothing",
        names="TransitionCallbackReturn LifecyclePublisher",
    ),
    Word("`return TransitionCallbackReturn.FAILURE`", '`raise TransitionRefused("why")`; any other error is `ERROR`'),
    Word(
        "`create_lifecycle_publisher(...)`",
        "`create_publisher(...)`, or a declared `Publisher`: in a `LifecycleNode` all are silent until it is active",
        "create_lifecycle_publisher destroy_lifecycle_publisher add_managed_entity",
    ),
    Word("`tf2_ros`", "in [code written for rclpy](rclpy.md); for native nodes not yet"),
    Word("`use_sim_time`, `/clock`", "the same"),
    Word(
        "`SubscriptionEventCallbacks`, `PublisherEventCallbacks`", "`on_event=` with a method that takes a `QosEvent`"
    ),
    Word("`publisher.assert_liveliness()`", "the same"),
    Word("`qos_profile_sensor_data` and so on", "`graphflow.qos.SENSOR_DATA` and so on"),
    Word("`service.configure_introspection(...)`", 'the same, or `@service(..., introspection="contents")`'),
    Word("code in `__init__` that opens devices", "`async def on_start(self)`, and `on_shutdown` at the end"),
    Word("`rclpy.spin` in a thread, `wait_for_message`", "`async for message in self.chatter:` in a `@task`"),
)


EXAMPLES = {
    example.lstrip("@").partition("(")[0].partition(",")[0]: example
    for example in (
        'Publisher(String, "chatter", depth=10)',
        'Subscription(String, "chatter", depth=10)',
        'Client(AddTwoInts, "add")',
        'ActionClient(Fibonacci, "fibonacci")',
        "Param(1.0, ge=0.0, le=5.0)",
        "Group(1)",
        '@subscription(String, "chatter", depth=10)',
        '@service(AddTwoInts, "add")',
        '@action(Fibonacci, "fibonacci")',
        "@timer(0.5)",
        "@task, without parentheses",
        'create_publisher(String, "chatter", 10)',
        'create_subscription(String, "chatter", self.heard, 10)',
        'create_service(AddTwoInts, "add", self.add)',
        'create_client(AddTwoInts, "add")',
        'create_action_server(Fibonacci, "fibonacci", self.count)',
        'create_action_client(Fibonacci, "fibonacci")',
        "create_timer(0.5, self.tick)",
        'declare_parameter("rate", 1.0)',
        "call(AddTwoInts.Request(a=1, b=2), timeout=2.0)",
        "send(Fibonacci.Goal(order=10))",
        "send_goal(Fibonacci.Goal(order=10))",
        'publish(String(data="hello"))',
    )
} | {"Timer": "@timer(0.5), lower-case, above a method"}
"""How a call is written whose arguments are wrong, by the name of the function."""

OF_PARTS = {
    "publish": 'a publisher has it: words = Publisher(String, "words") in the class, self.words.publish(message)',
    "call": 'a client has it: adder = Client(AddTwoInts, "add") in the class, await self.adder.call(request)',
    "send_goal": "an ActionClient of the class has it",
    "sleep": "the clock has it: await self.clock.sleep(0.5)",
    "now": "the clock has it: self.clock.now()",
    **{level: f"the logger has it: self.log.{level}(...)" for level in ("debug", "info", "warning", "error")},
    "warn": "the logger has it: self.log.warning(...)",
    "logger": "here it is self.log",
}
"""Attributes that are looked for on a node, and belong to what it holds."""

Kind = Literal["attributes", "keywords", "names"]


@cache
def _by(kind: Kind) -> dict[str, Word]:
    return {name: word for word in WORDS for name in getattr(word, kind).split()}


def translation(name: str, kind: Kind = "attributes") -> str:
    """What something of rclpy's is called here; empty for what is not rclpy's."""
    word = _by(kind).get(name)
    return "" if word is None else f"here it is {word.here}".replace("`", "")


def in_our_words(function: Callable[P, T]) -> Callable[P, T]:
    """A function that answers rclpy's keywords, and arguments that go by name here, with what to write."""
    parameters = inspect.signature(function).parameters.values()
    named = {p.name for p in parameters}
    first = [p.name for p in parameters if p.kind is p.POSITIONAL_OR_KEYWORD]
    rest = [f"{p.name}=" for p in parameters if p.kind is p.KEYWORD_ONLY]
    rest += [p.name for p in parameters if p.kind is p.VAR_KEYWORD]
    called = function.__qualname__.removesuffix(".__init__").rpartition(".")[2]

    @wraps(function)
    def checked(*args: P.args, **kwargs: P.kwargs) -> T:
        for word in kwargs.keys() - named:
            if hint := translation(word, "keywords"):
                raise DeclarationError(f"{here()}: {called} has no {word}=; {hint}")
        if len(args) > len(first):
            if called == "Param" and isinstance(args[1], str):
                way = f"leave out {args[1]!r}, the parameter has the name of its attribute; write Param({args[2]!r})"
                raise DeclarationError(f"{here()}: {called} takes no name first: {way}")
            taken = ", ".join(name for name in first if name != "self")
            more = f"; what follows goes by name: {', '.join(rest)}" if rest else ""
            raise DeclarationError(f"{here()}: {called} takes {taken}{more}")
        try:
            return function(*args, **kwargs)
        except TypeError:
            fault = _fault(function, args, kwargs)
            if not fault:
                raise
        raise DeclarationError(f"{here()}: {called} {fault}; write {EXAMPLES[called]}")

    return checked


def _fault(function: Callable[..., Any], args: tuple[Any, ...], kwargs: dict[str, Any]) -> str:
    """How arguments do not fit a function, after its name; empty if they do, and the error is another."""
    signature = inspect.signature(function)
    try:
        signature.bind(*args, **kwargs)
    except TypeError:
        pass
    else:
        return ""
    taken = [name for name in signature.parameters if name != "self"]
    strange = [word for word in kwargs if word not in taken]
    if strange:
        near = nearest(strange[0], taken)
        return f"has no {strange[0]}={f' (but {near}=)' if near else ''}"
    try:
        given = signature.bind_partial(*args, **kwargs).arguments
    except TypeError as error:
        return f"was given {error}"
    needed = [p.name for p in signature.parameters.values() if p.default is p.empty and p.name not in given]
    return f"needs {' and '.join(needed)}"


class MadeByNodes:
    """What nodes make: rclpy's constructors, which take the node first, are answered with what to write."""

    MAKER: ClassVar[str] = ""
    """How a node makes one: `create_timer(1.0, self.tick)`."""

    def __new__(cls, *args: object, **_: object) -> Self:
        if args and hasattr(type(args[0]), "create_subscription"):
            raise DeclarationError(f"{here()}: {cls.__name__} takes no node; write self.{cls.MAKER}")
        return super().__new__(cls)


class SpeaksRos:
    """A class of whose missing attributes reports say what rclpy's are called here; see `attribute_errors`."""

    __slots__ = ()

    def _hint(self, name: str) -> str:
        """What else could be meant by an attribute that is not there."""
        return ""

    def _instead_of(self, name: str) -> str:
        """The whole text about an attribute that is not there, where Python's own does not help; empty otherwise."""
        return ""


def page() -> str:
    """The table of the page."""
    rows = (f"| {word.ros} | {word.here} |" for word in WORDS)
    return "\n".join(["| rclpy | graphflow |", "|---|---|", *rows])


if __name__ == "__main__":
    sys.stdout.write(page() + "\n")
