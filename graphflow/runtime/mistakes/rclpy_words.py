"""The equivalents of rclpy's names in graphflow: one table for error messages and for the page "coming from ROS 2".

`python -m graphflow.runtime.mistakes.rclpy_words` prints the table of that page.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from functools import cache, wraps
from types import FunctionType, MethodType
from typing import Any, ClassVar, Literal, NamedTuple, ParamSpec, Self, TypeVar

from graphflow.errors import DeclarationError
from graphflow.names import nearest
from graphflow.runtime.call_site import here

P = ParamSpec("P")
T = TypeVar("T")


class Equivalent(NamedTuple):
    """One row of the table.

    Attributes:
        ros: The code with rclpy.
        here: The code with graphflow.
        attributes: Attributes of rclpy's objects without a counterpart of that name; errors about them suggest `here`.
        keywords: The same for keywords of rclpy's calls.
        names: The same for names imported from rclpy.
    """

    ros: str
    here: str
    attributes: str = ""
    keywords: str = ""
    names: str = ""


EQUIVALENTS = (
    Equivalent(
        "`rclpy.init`, `spin`, `shutdown`",
        "`graphflow.run(Talker)`; in your own program `async with graphflow.running(node):`",
        names="init spin shutdown ok try_shutdown create_node",
    ),
    Equivalent(
        "`spin_once`, `spin_until_future_complete`",
        "not needed: `await`",
        "executor",
        names="spin_once spin_until_future_complete",
    ),
    Equivalent('`super().__init__("talker")`', "the same, or omit it: the name is then the class name in snake case"),
    Equivalent("`from std_msgs.msg import String`", "`from graphflow.msgs.std_msgs.msg import String`"),
    Equivalent(
        '`create_publisher(String, "chatter", 10)`', 'the same, or `chatter = Publisher(String, "chatter", 10)`'
    ),
    Equivalent(
        '`create_subscription(String, "chatter", self.heard, 10)`',
        'the same, or `@subscription(String, "chatter", 10)`',
        names="subscriber Subscriber",
    ),
    Equivalent("`create_timer(1.0, self.tick)`", "the same, or `@timer(1.0)`, `@timer(hz=rate)`"),
    Equivalent(
        '`create_service(Srv, "name", self.answer)`',
        'the same, or `@service(Srv, "name")`; the handler takes `(request)` or `(request, response)`',
    ),
    Equivalent('`create_client(Srv, "name")`', 'the same, or `Client(Srv, "name")`'),
    Equivalent("`client.call_async(request)`, then spin", "`await client.call(request, timeout=2.0)`", "call_async"),
    Equivalent("`client.call(request)`", "the same with `await`; the rest of the node keeps running"),
    Equivalent(
        "`client.wait_for_service(1.0)`",
        "`await client.wait_ready(1.0)`, which returns True or False",
        "wait_for_service wait_for_server",
    ),
    Equivalent("`client.service_is_ready()`", "the same"),
    Equivalent("`future.add_done_callback(f)`", "the lines after the `await`"),
    Equivalent(
        '`declare_parameter("rate", 1.0)`',
        '`rate = Param(1.0)`, then `self.rate`; `self.declare_parameter("rate", 1.0)` returns a copy of the value: '
        'read `self.parameters.get("rate")` for the current one',
    ),
    Equivalent(
        "`declare_parameters(ns, [...])`",
        "one `Param` each in the class, or one `self.declare_parameter` each",
        "declare_parameters",
    ),
    Equivalent(
        '`get_parameter("rate").value`',
        '`self.parameters.get("rate")`; `self.rate` if the class has `rate = Param(1.0)`',
        "get_parameter get_parameters get_parameter_or get_parameters_by_prefix get_parameter_type get_parameter_types",
    ),
    Equivalent('`has_parameter("rate")`', '`"rate" in self.parameters`', "has_parameter"),
    Equivalent(
        "`set_parameters([...])`",
        '`self.rate = 2.0`, or `self.parameters.set({"rate": 2.0})`',
        "set_parameters set_parameters_atomically",
    ),
    Equivalent(
        "`describe_parameter(name)`", "`self.parameters.describe(name)`", "describe_parameter describe_parameters"
    ),
    Equivalent(
        "`add_on_set_parameters_callback`",
        "limits in `Param`, or a method with `@rate.check`; for several parameters at once `self.parameters.check(f)`",
        "add_on_set_parameters_callback add_pre_set_parameters_callback set_parameters_callback",
    ),
    Equivalent(
        "`add_post_set_parameters_callback`",
        "a method with `@rate.on_change`, or `self.parameters.observe(f)`",
        "add_post_set_parameters_callback",
    ),
    Equivalent(
        "`ParameterDescriptor`, ranges",
        '`Param(1.0, ge=0.0, le=5.0, step=0.5, doc="...", read_only=True)`; `declare_parameter` takes them, too',
        keywords="descriptor min max",
        names="ParameterDescriptor",
    ),
    Equivalent("`dynamic_typing=True`", '`self.declare_parameter("name", 1, dynamic=True)`'),
    Equivalent("`undeclare_parameter`", "the same"),
    Equivalent("a callback with `(msg, info)`", "a method with a third argument, `info: MessageInfo`"),
    Equivalent("`ignore_local_publications`", "`ignore_local=True`"),
    Equivalent('`get_logger().info("...")`', '`self.log.info("...")`, a Python logger', "get_logger"),
    Equivalent(
        "`get_logger().info(..., throttle_duration_sec=1.0)`, `once=True`",
        '`self.log.info("...", throttle=1.0)`, `once=True`',
    ),
    Equivalent(
        "`get_clock().now()`",
        "`self.clock.now()`; no `.to_msg()`, since a `Time` can be put into a message",
        "get_clock",
    ),
    Equivalent("`now().to_msg()`", "the `Time` itself, which can be put into a message", "to_msg"),
    Equivalent("`now().nanoseconds`", "the same; `.seconds` as a float"),
    Equivalent("`Duration(seconds=1.0)`", "`Duration.of(1.0)`"),
    Equivalent("`create_rate(10).sleep()`", "`async for n in self.clock.every(hz=10.0):`", "create_rate", names="Rate"),
    Equivalent("`create_guard_condition`", "an `asyncio.Event` that a `@task` awaits", "create_guard_condition"),
    Equivalent(
        "`get_name()`, `get_namespace()`, `get_fully_qualified_name()`",
        "`node.name`, `node.namespace`, `node.full_name`",
        "get_name get_namespace get_fully_qualified_name",
    ),
    Equivalent(
        "`get_topic_names_and_types()`, `get_node_names()`",
        "`self.context.cache.topics()`, `.nodes()`, `.services()`, `.actions()`",
        "get_topic_names_and_types get_service_names_and_types get_node_names get_node_names_and_namespaces"
        " get_publishers_info_by_topic get_subscriptions_info_by_topic count_publishers count_subscribers",
    ),
    Equivalent("`publisher.get_subscription_count()`", "the same"),
    Equivalent("`publisher.topic_name`, `client.srv_name`", "`.name`", "topic topic_name srv_name service_name"),
    Equivalent(
        "`QoSProfile(depth=1, durability=...)`, `qos_profile=`",
        "`Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)`, `qos=`",
        keywords="qos_profile",
        names="QoSProfile",
    ),
    Equivalent(
        "`MutuallyExclusiveCallbackGroup()`",
        "`Group(1)`; a class's `default_group = Group(1)` is rclpy's default",
        "default_callback_group",
        names="MutuallyExclusiveCallbackGroup",
    ),
    Equivalent("`ReentrantCallbackGroup()`", "`Group(None)`", names="ReentrantCallbackGroup CallbackGroup"),
    Equivalent("`callback_group=`", "`group=`, with a `Group` of the class", keywords="callback_group"),
    Equivalent(
        "`SingleThreadedExecutor`, `MultiThreadedExecutor`",
        "one event loop per process; `thread=True` and `await self.offload(f)` for code that blocks",
        names="SingleThreadedExecutor MultiThreadedExecutor",
    ),
    Equivalent(
        "`destroy_publisher(p)` and so on",
        "`p.close()`",
        "destroy_publisher destroy_subscription destroy_client destroy_service destroy_timer destroy_rate destroy",
    ),
    Equivalent(
        "`destroy_node()`",
        "not needed: done at the end of `run` or `running`; `self.shutdown()` ends the node from within",
        "destroy_node",
    ),
    Equivalent(
        '`ActionServer(node, Type, "name", execute)`',
        '`@action(Type, "name")` on the method, or `self.create_action_server(Type, "name", self.execute)`',
        keywords="execute_callback",
    ),
    Equivalent(
        "`goal_callback=`, `GoalResponse.REJECT`",
        "`accept=`, a method that returns True, False, or the reason for a rejection, which the client receives",
        keywords="goal_callback",
        names="GoalResponse",
    ),
    Equivalent(
        "`cancel_callback=`, `CancelResponse.REJECT`",
        "`cancellable=`: True, False, or a method that takes the goal and decides",
        keywords="cancel_callback",
        names="CancelResponse",
    ),
    Equivalent(
        "`handle_accepted_callback=`, `goal_handle.execute()`",
        "`policy=`: `reject`, `queue`, `preempt` or `parallel`",
        "execute",
        keywords="handle_accepted_callback",
    ),
    Equivalent(
        '`ActionClient(node, Type, "name")`',
        '`ActionClient(Type, "name")`, then `async with self.client.send(goal) as sent:`',
    ),
    Equivalent(
        "`send_goal_async(goal)`, `get_result_async()`",
        "`async with client.send(goal) as sent:`, then `await sent.result()`",
        "send_goal_async get_result_async get_result",
    ),
    Equivalent("`cancel_goal_async()`", "`await sent.cancel()`", "cancel_goal_async cancel_goal"),
    Equivalent("`ServerGoalHandle`, `ClientGoalHandle`", "the same; a handler's argument is annotated `Type.Handle`"),
    Equivalent("`goal_handle.publish_feedback(f)`", "`goal.feedback(f)`", "publish_feedback"),
    Equivalent(
        "`goal_handle.is_cancel_requested`", "the same; cancellation also raises `CancelledError` at an `await`"
    ),
    Equivalent("`goal_handle.succeed()`", "return the result", "succeed"),
    Equivalent("`goal_handle.abort()`", "`raise Abort(reason)`", "abort"),
    Equivalent("`goal_handle.canceled()`", "let `CancelledError` propagate; `goal.partial` is the result", "canceled"),
    Equivalent(
        "`LifecycleNode`, `on_configure(self, state)`",
        "`LifecycleNode`, `async def on_configure(self)`; it succeeds by returning None",
        names="TransitionCallbackReturn LifecyclePublisher",
    ),
    Equivalent(
        "`return TransitionCallbackReturn.FAILURE`", '`raise TransitionRefused("why")`; any other error is `ERROR`'
    ),
    Equivalent(
        "`create_lifecycle_publisher(...)`",
        "`create_publisher(...)`, or a declared `Publisher`: in a `LifecycleNode` they send only while it is active",
        "create_lifecycle_publisher destroy_lifecycle_publisher add_managed_entity",
    ),
    Equivalent(
        "`Buffer()`, `TransformListener(buffer, self)`", "`tf = Transforms()` in the class: [transforms](transforms.md)"
    ),
    Equivalent(
        "`self.tf_buffer`",
        "`self.tf`, with `tf = Transforms()` in the class, from `graphflow.tf`",
        "tf tf_buffer buffer",
    ),
    Equivalent(
        "`buffer.lookup_transform(target, source, time, timeout)`",
        "`await self.tf.lookup(target, source, at=time, timeout=1.0)`, or `self.tf.get(...)`",
        "lookup_transform lookup_transform_async can_transform",
    ),
    Equivalent(
        "`lookup_transform_full(...)`",
        '`self.tf.get(target, source, at=then, fixed="odom", target_at=now)`',
        "lookup_transform_full lookup_transform_full_async",
    ),
    Equivalent(
        "`TransformBroadcaster(self).sendTransform(t)`",
        "`self.tf.send(t)`; static: `self.tf.send_static(t)`",
        "sendTransform send_transform",
    ),
    Equivalent("`tf2_geometry_msgs.do_transform_point(p, t)`", '`t.apply(p)`, or `await self.tf.transform(p, "map")`'),
    Equivalent("`use_sim_time`, `/clock`", "the same"),
    Equivalent(
        "`SubscriptionEventCallbacks`, `PublisherEventCallbacks`", "`on_event=` with a method that takes a `QosEvent`"
    ),
    Equivalent("`publisher.assert_liveliness()`", "the same"),
    Equivalent("`qos_profile_sensor_data` and so on", "`graphflow.qos.SENSOR_DATA` and so on"),
    Equivalent("`service.configure_introspection(...)`", 'the same, or `@service(..., introspection="contents")`'),
    Equivalent("code in `__init__` that opens devices", "`async def on_start(self)`, and `on_shutdown` at the end"),
    Equivalent("`rclpy.spin` in a thread, `wait_for_message`", "`async for message in self.chatter:` in a `@task`"),
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
"""Correct calls for errors about wrong arguments, by the function's name."""

OF_PARTS = {
    "publish": 'that is for publishers: words = Publisher(String, "words") in the class, self.words.publish(message)',
    "call": 'that is for clients: adder = Client(AddTwoInts, "add") in the class, await self.adder.call(request)',
    "send_goal": "that is for action clients, which the class declares",
    "sleep": "that is for the clock: await self.clock.sleep(0.5)",
    "now": "that is for the clock: self.clock.now()",
    **{level: f"that is for the logger: self.log.{level}(...)" for level in ("debug", "info", "warning", "error")},
    "warn": "that is for the logger: self.log.warning(...)",
    "logger": "in graphflow it is self.log",
}
"""Hints for attributes that users look up on a node and that belong to its parts."""

Kind = Literal["attributes", "keywords", "names"]


@cache
def _by(kind: Kind) -> dict[str, Equivalent]:
    return {name: word for word in EQUIVALENTS for name in getattr(word, kind).split()}


def translation(name: str, kind: Kind = "attributes") -> str:
    """Return a hint with the graphflow equivalent of one of rclpy's names; "" for other names."""
    word = _by(kind).get(name)
    return "" if word is None else f"in graphflow it is {word.here}".replace("`", "")


_POLICIES = {"reliability", "durability", "history", "liveliness", "deadline_ns", "lifespan_ns", "lease_ns"}
"""Arguments of a Qos."""


def with_argument_hints(function: Callable[P, T]) -> Callable[P, T]:
    """Decorate a function: wrong arguments raise DeclarationError with the correct call or rclpy's equivalent."""
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
            if called == "Param" and isinstance(args[1], type):
                way = f"the default decides it: write Param({args[2]!r}, ...)"
                raise DeclarationError(f"{here()}: {called} takes no type; {way}")
            if called == "Param" and isinstance(args[1], str):
                way = f"leave out {args[1]!r}, the parameter has the name of its attribute; write Param({args[2]!r})"
                raise DeclarationError(f"{here()}: {called} takes no name first: {way}")
            if called == "timer" and isinstance(args[1], FunctionType | MethodType):
                name = args[1].__name__
                way = f"write self.create_timer({args[0]!r}, self.{name}), or @timer({args[0]!r}) above {name}"
                raise DeclarationError(f"{here()}: @timer takes no callback: {way}")
            taken = ", ".join(name for name in first if name != "self")
            more = f"; pass the rest by keyword: {', '.join(rest)}" if rest else ""
            raise DeclarationError(f"{here()}: {called} takes {taken}{more}")
        try:
            return function(*args, **kwargs)
        except TypeError:
            fault = _fault(function, args, kwargs)
            if not fault:
                raise
        way = "put what blocks into await self.offload(...)" if "thread" in kwargs else f"write {EXAMPLES[called]}"
        raise DeclarationError(f"{here()}: {called} {fault}; {way}")

    return checked


def _fault(function: Callable[..., object], args: tuple[Any, ...], kwargs: dict[str, Any]) -> str:
    """Describe how arguments do not fit a function; "" if they do, and the error has another cause."""
    signature = inspect.signature(function)
    try:
        signature.bind(*args, **kwargs)
    except TypeError:
        pass
    else:
        return ""
    taken = [name for name in signature.parameters if name != "self"]
    strange = [word for word in kwargs if word not in taken]
    if strange and strange[0] in _POLICIES:
        return f"has no {strange[0]}=, which belongs to qos=Qos(depth=10, {strange[0]}=...)"
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
    """A class that nodes instantiate. A call as in rclpy, with the node first, raises an error with a hint."""

    MAKER: ClassVar[str] = ""
    """The call that creates one on a node: `create_timer(1.0, self.tick)`."""

    def __new__(cls, *args: object, **_: object) -> Self:
        if args and hasattr(type(args[0]), "create_subscription"):
            raise DeclarationError(f"{here()}: {cls.__name__} takes no node; write self.{cls.MAKER}")
        return super().__new__(cls)


class AttributeHints:
    """A class with hints for missing attributes, including rclpy's; see `attribute_errors`."""

    __slots__ = ()

    def _hint(self, name: str) -> str:
        """Return a hint to append to the error about a missing attribute; "" if there is none.

        `IT` in it stands for the object, and becomes the name by which the user's line calls it.
        """
        return ""

    def _instead_of(self, name: str) -> str:
        """Return a text that replaces Python's error about a missing attribute; "" to keep Python's."""
        return ""


def hint_of(thing: AttributeHints, name: str) -> str:
    """Return the hint of an object about an attribute that it lacks; "" if there is none."""
    # The methods have an underscore because their class is a base of nodes, whose public names are the user's.
    return thing._hint(name)


def text_instead(thing: AttributeHints, name: str) -> str:
    """Return the text of an object that replaces Python's about an attribute that it lacks; "" if there is none."""
    return thing._instead_of(name)


def page() -> str:
    """Return the table as Markdown."""
    rows = (f"| {word.ros} | {word.here} |" for word in EQUIVALENTS)
    return "\n".join(["| rclpy | graphflow |", "|---|---|", *rows])


if __name__ == "__main__":
    sys.stdout.write(page() + "\n")
