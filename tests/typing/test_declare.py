"""What a type checker lets through and refuses about nodes. Checked, never called: an unused ignore is a failure."""

from collections.abc import AsyncIterator, Callable, Coroutine
from typing import Any, assert_type

from graphflow import (
    Client,
    Context,
    Group,
    Node,
    Param,
    Publisher,
    Qos,
    Subscription,
    Time,
    TimerInfo,
    service,
    subscription,
    task,
    timer,
)
from graphflow.msgs.example_interfaces.srv import AddTwoInts, AddTwoInts_Request, AddTwoInts_Response
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.msgs.std_srvs.srv import Empty, Trigger
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.endpoints.service_client import ServiceClient
from graphflow.runtime.endpoints.services import ServiceServer
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.endpoints.timer import Timer
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph, Tap
from graphflow.wire.attachment import MessageInfo


class Everything(Node):
    """Declares one of each."""

    flag = Param(True)
    count = Param(3, ge=0)
    rate = Param(1.0, unit="Hz", gt=0.0)
    title = Param("hello")
    blob = Param(b"raw")
    gains = Param([1.0, 2.0])
    out = Publisher(String, "out")
    incoming = Subscription(Int32, "in", Qos(depth=5))
    adder = Client(AddTwoInts, "add")
    io = Group(None)

    @subscription(String, "chatter", depth=3, group=io)
    async def heard(self, message: String) -> None: ...

    @subscription(String, "chatter", thread=True)
    def heard_in_a_thread(self, message: String, loudly: bool = False) -> int:
        return 0

    @timer(hz=rate)
    async def tick(self) -> None: ...

    @timer(0.5, group=io)
    def tock(self, info: TimerInfo) -> None: ...

    @service(AddTwoInts, "add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)

    @task
    async def run(self) -> None: ...


class Child(Everything):
    """Overrides a body and a default."""

    rate = Param(10.0)

    async def heard(self, message: String) -> None:
        await super().heard(message)


def parameters_have_the_type_of_their_default(node: Everything, child: Child) -> None:
    assert_type(node.flag, bool)
    assert_type(node.count, int)
    assert_type(node.rate, float)
    assert_type(node.title, str)
    assert_type(node.blob, bytes)
    assert_type(node.gains, list[float])
    assert_type(child.rate, float)
    assert_type(Everything.rate, Param[float])
    node.rate = 2
    node.rate = 2.5
    node.rate = "fast"  # type: ignore[assignment]
    node.count = 2.5  # type: ignore[assignment]
    node.title = None  # type: ignore[assignment]
    node.gains = [1, 2]
    node.gains = ["a"]  # type: ignore[list-item]
    text: str = node.rate  # type: ignore[assignment]
    del text


def parameters_are_of_a_few_types() -> None:
    Param(None)  # type: ignore[type-var]
    Param({"a": 1})  # type: ignore[type-var]
    Param([{"a": 1}])  # type: ignore[type-var]
    Param(1.0, gt="0")  # type: ignore[arg-type]
    Param(1.0, min=0.0)  # type: ignore[call-arg]


def what_is_published_is_of_the_topics_type(node: Everything) -> None:
    assert_type(node.out, TopicPublisher[String])
    assert_type(Everything.out, Publisher[String])
    node.out.publish(String(data="x"))
    node.out.publish(Int32())  # type: ignore[arg-type]
    node.out.publish("x")  # type: ignore[arg-type]
    node.out.publish(String(data=1))  # type: ignore[arg-type]
    node.out.publsh(String())  # type: ignore[attr-defined]
    assert_type(node.out.get_subscription_count(), int)


def the_type_comes_first() -> None:
    Publisher("out", String)  # type: ignore[arg-type]
    Publisher(str, "out")  # type: ignore[type-var]
    Publisher(AddTwoInts, "out")  # type: ignore[type-var]
    Publisher(String)  # type: ignore[call-arg]
    Subscription(String(), "in")  # type: ignore[arg-type]
    Client(String, "add")  # type: ignore[arg-type]
    Client(AddTwoInts.Request, "add")  # type: ignore[arg-type]
    Group("io")  # type: ignore[arg-type]


async def what_is_heard_is_of_the_topics_type(node: Everything) -> None:
    assert_type(node.incoming, TopicSubscription[Int32])
    async for message in node.incoming:
        assert_type(message, Int32)
        message.text  # type: ignore[attr-defined]  # noqa: B018
    assert_type(aiter(node.incoming), AsyncIterator[Int32])
    assert_type(await node.incoming.next_with_info(), tuple[Int32, MessageInfo])
    assert_type(node.incoming.dropped, int)


async def an_answer_is_of_the_services_type(node: Everything) -> None:
    assert_type(node.adder, ServiceClient[AddTwoInts_Request, AddTwoInts_Response])
    response = await node.adder.call(AddTwoInts.Request(a=1, b=2), timeout=None)
    assert_type(response, AddTwoInts_Response)
    assert_type(response.sum, int)
    await node.adder.call(AddTwoInts.Response())  # type: ignore[arg-type]
    await node.adder.call(Trigger.Request())  # type: ignore[arg-type]
    await node.adder.call(a=1, b=2)  # type: ignore[call-arg]
    response.total  # type: ignore[attr-defined]  # noqa: B018
    assert_type(await node.adder.wait_ready(1.0), bool)


async def decorators_return_the_function(node: Everything) -> None:
    assert_type(await node.heard(String()), None)
    await node.heard(message=String())
    await node.heard(Int32())  # type: ignore[arg-type]
    assert_type(node.heard_in_a_thread(String(), loudly=True), int)
    assert_type(await node.add(AddTwoInts.Request()), AddTwoInts_Response)
    await node.add(String())  # type: ignore[arg-type]
    node.tock(TimerInfo(0, 0, 0))
    node.tock()  # type: ignore[call-arg]
    await node.tick()


async def handler(message: String) -> None: ...


async def add(request: AddTwoInts.Request) -> AddTwoInts.Response:
    return AddTwoInts.Response()


def decorators_take_a_type_and_a_name(
    fn: Callable[[Everything, String], None], co: Callable[[Everything], Coroutine[Any, Any, None]]
) -> None:
    assert_type(subscription(String, "x")(fn), Callable[[Everything, String], None])
    assert_type(task(co), Callable[[Everything], Coroutine[Any, Any, None]])
    subscription("x", String)  # type: ignore[arg-type]
    subscription(AddTwoInts, "x")  # type: ignore[type-var]
    subscription(String, "x", group="io")  # type: ignore[arg-type]
    subscription(String, "x")(1)  # type: ignore[type-var]
    service(String, "x")  # type: ignore[arg-type]
    service(AddTwoInts.Request, "x")  # type: ignore[arg-type]
    timer("often")  # type: ignore[arg-type]
    timer(period=1.0, thread="yes")  # type: ignore[arg-type]
    timer(hz=Everything.rate)
    task(1)  # type: ignore[type-var]


def what_create_returns(node: Node) -> None:
    assert_type(node.create_publisher(String, "x"), TopicPublisher[String])
    assert_type(node.create_subscription(String, "x", handler), TopicSubscription[String])
    assert_type(node.create_subscription(String, "x", None, 5), TopicSubscription[String])
    assert_type(node.create_service(AddTwoInts, "x", add), ServiceServer[AddTwoInts_Request, AddTwoInts_Response])
    assert_type(node.create_client(AddTwoInts, "x"), ServiceClient[AddTwoInts_Request, AddTwoInts_Response])
    assert_type(node.create_timer(0.1, lambda: None), Timer)
    node.create_subscription(Int32, "x", handler)  # type: ignore[arg-type]
    node.create_subscription(String, handler, "x")  # type: ignore[arg-type]
    node.create_service(Trigger, "x", add)  # type: ignore[arg-type]
    node.create_publisher("x", String)  # type: ignore[arg-type]
    node.create_timer("fast", lambda: None)  # type: ignore[arg-type]
    node.create_publisher(String, "x").publish(Int32())  # type: ignore[arg-type]


async def nodes(node: Node, context: Context) -> None:
    Everything("name", namespace="/a", remap=["a:=b"], rate=2.0)
    Everything(1)  # type: ignore[arg-type]
    Everything(remap=[1])  # type: ignore[list-item]
    assert_type(await node.offload(pow, 2, 3), int)
    assert_type(await node.offload(len, "x"), int)
    assert_type(node.clock.now(), Time)
    assert_type(node.full_name, str)
    await core_of(node).start(context)
    await core_of(node).start("here")  # type: ignore[arg-type]
    node.spawn(handler, String())
    node.spawn(handler(String()))  # type: ignore[arg-type]


async def graphs_of_tests_are_typed(graph: Graph) -> None:
    heard = graph.tap(String, "/x")
    assert_type(heard, Tap[String])
    assert_type(heard.latest, String)
    assert_type([m.data for m in heard], list[str])
    assert_type(await graph.call(AddTwoInts, "/add", AddTwoInts.Request()), AddTwoInts_Response)
    await graph.call(AddTwoInts, "/add", Empty.Request())  # type: ignore[misc]
    graph.publisher(String, "/x").publish(Int32())  # type: ignore[arg-type]
