"""Characters that several tests share."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator, Callable, Coroutine
from contextlib import asynccontextmanager
from typing import Any

import pytest

from graphflow import (
    ActionClient,
    Client,
    Context,
    DeclarationError,
    Group,
    Node,
    Param,
    Publisher,
    Subscription,
    action,
    service,
    subscription,
    task,
    timer,
)
from graphflow.errors import Place
from graphflow.interface import Interface, Parameter, ParamType
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.rcl_interfaces.msg import Parameter as ParameterMessage
from graphflow.msgs.rcl_interfaces.msg import ParameterValue
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.msgs.std_srvs.srv import Empty, Trigger
from graphflow.qos import Durability, Qos
from graphflow.runtime.actions.goal_handles import ClientGoalHandle
from graphflow.runtime.endpoints.service_client import ServiceClient
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph


class Log(list[Any]):
    """The calls of a handler."""

    def __call__(self, item: Any) -> None:
        self.append(item)


class Speaker(Node):
    """Holds a publisher and listens by iterating."""

    chatter = Publisher(String, "chatter")
    heard = Subscription(String, "chatter", 3)


async def nothing() -> None:
    """Do nothing."""


Goal = ClientGoalHandle[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback]


class Asker(Node):
    """Sends goals."""

    fibonacci = ActionClient(Fibonacci, "fibonacci")

    async def order(self, order: int) -> Goal:
        return await self.fibonacci.send_goal(Fibonacci.Goal(order=order))


class Server(Node):
    """Counts like rabbits, one generation a second, until cancelled."""

    rabbits = Group(None)

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.told = Log()
        self.bodies = 0

    def fits(self, goal: Fibonacci.Goal) -> bool:
        if goal.order == 13:
            raise ValueError("unlucky")
        return goal.order < 100

    def may_end(self, goal: Fibonacci.Handle) -> bool:
        return goal.request.order != 7

    @action(Fibonacci, "fibonacci", group=rabbits, accept=fits, cancellable=may_end)
    async def compute(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        sequence = [0, 1]
        self.bodies += 1
        assert self.bodies == 1
        try:
            while len(sequence) < goal.request.order:
                await self.clock.sleep(1.0)
                sequence.append(sequence[-1] + sequence[-2])
                goal.feedback(Fibonacci.Feedback(sequence=sequence.copy()))
                goal.partial = Fibonacci.Result(sequence=sequence.copy())
            return Fibonacci.Result(sequence=sequence)
        except asyncio.CancelledError as error:
            self.told(str(error))
            raise
        finally:
            self.bodies -= 1


async def pair(graph: Graph, server: Node | None = None) -> tuple[Any, Asker]:
    """Return a running action server and client."""
    made, asker = server or Server(), Asker()
    await graph.start(made, asker)
    return made, asker


class Adder(Node):
    """Serves in every way there is."""

    @service(AddTwoInts, "add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        await asyncio.sleep(0)
        return AddTwoInts.Response(sum=request.a + request.b)

    @service(AddTwoInts, "add_plain")
    def add_plain(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)

    @service(AddTwoInts, "add_in_thread", thread=True)
    def add_in_thread(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        assert threading.current_thread() is not threading.main_thread()
        return AddTwoInts.Response(sum=request.a + request.b)

    @service(Empty, "go")
    async def go(self, request: Empty.Request) -> None:
        """Return an empty response."""

    @service(AddTwoInts, "raises")
    async def raises(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        raise ValueError(f"{request.a} is too much")

    @service(AddTwoInts, "raises_plainly")
    def raises_plainly(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        raise KeyError("lost")

    @service(AddTwoInts, "wrong_type")
    async def wrong_type(self, request: AddTwoInts.Request) -> Any:
        return Trigger.Response()

    @service(AddTwoInts, "returns_nothing")
    async def returns_nothing(self, request: AddTwoInts.Request) -> Any:
        return None

    @service(AddTwoInts, "wrong_field")
    async def wrong_field(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        response = AddTwoInts.Response()
        response.sum = 2**70
        return response

    @service(AddTwoInts, "cancelled_inside")
    async def cancelled_inside(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        inner = asyncio.ensure_future(asyncio.Event().wait())
        inner.cancel()
        await inner
        return AddTwoInts.Response()


class SlowAdder(Node):
    """Answer on request."""

    def __init__(self) -> None:
        super().__init__()
        self.gate = asyncio.Event()
        self.asked = Log()

    @service(AddTwoInts, "add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        self.asked(request.a)
        await self.gate.wait()
        return AddTwoInts.Response(sum=request.a + request.b)


async def client_of(graph: Graph, name: str = "add") -> ServiceClient[AddTwoInts.Request, AddTwoInts.Response]:
    """A client in a node of its own."""
    node = Node("caller")
    client = node.create_client(AddTwoInts, name)
    await graph.start(node)
    return client


async def begun(graph: Graph, call: Coroutine[Any, Any, AddTwoInts.Response]) -> asyncio.Task[AddTwoInts.Response]:
    """A call under way."""
    task = asyncio.create_task(call)
    await graph.settle()
    return task


class Talker(Node):
    """Has a name of every kind."""

    rate = Param(1.0, gt=0.0)
    chatter = Publisher(String, "chatter")
    private = Publisher(String, "~/private")
    absolute = Publisher(String, "/absolute")
    adder = Client(AddTwoInts, "add")


class Everything(Node):
    """Declares one of each.

    And says so.
    """

    node_name = "all"
    dynamic_names = ("*/pose",)

    rate = Param(2.0, unit="Hz", doc="How often.", gt=0.0, le=10.0)
    frozen = Param([1, 2], name="frozen.list", read_only=True)
    out = Publisher(String, "~/out", 5)
    incoming = Subscription(Int32, "/in", Qos(durability=Durability.TRANSIENT_LOCAL))
    adder = Client(AddTwoInts, "add")
    io = Group(None)
    one = Group()

    @subscription(String, "chatter", depth=3, group=io)
    async def heard(self, message: String) -> None: ...

    @timer(hz=rate, group=one)
    async def tick(self) -> None: ...

    @service(AddTwoInts, "sum", thread=True)
    def sum(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response()

    @task
    async def run(self) -> None: ...


def message(name: str, value: Any, type_: int) -> ParameterMessage:
    """A parameter as it travels."""
    fields = ["", "bool_value", "integer_value", "double_value", "string_value"]
    return ParameterMessage(name=name, value=ParameterValue(type=type_, **{fields[type_]: value}))


class Parent(Node):
    """A base class with one of each."""

    rate = Param(1.0, gt=0.0)
    gain = Param(5.0)
    out = Publisher(String, "out")
    said: list[str]

    def __init__(self, name: str | None = None) -> None:
        super().__init__(name)
        self.said = []

    @timer(hz=rate)
    async def tick(self) -> None:
        self.said.append("parent ticks")

    @subscription(String, "in")
    async def heard(self, message: String) -> None:
        self.said.append(f"parent hears {message.data}")


class Child(Parent):
    """Overrides a default and a body, and adds a handler."""

    rate = Param(10.0, gt=0.0)
    extra = Publisher(Int32, "extra")

    async def heard(self, message: String) -> None:
        await super().heard(message)
        self.said.append(f"child hears {message.data}")

    @timer(0.25)
    async def tock(self) -> None:
        self.said.append("child tocks")


def names_of(interface: Interface) -> tuple[str, ...]:
    """The names of the handlers that a class declares."""
    return tuple(handler.name for handler in interface.handlers)


def parameter(name: str, type_: ParamType, default: Any, **limits: Any) -> Parameter:
    """A parameter as a class declares it."""
    return Parameter(name, type_, default, Place("here", 1), **limits)


def anything(value: Any) -> Any:
    """Hide a value's type."""
    return value


def refusal_of(make: Callable[[], object]) -> str:
    """Return the error of a wrong declaration, after its place."""
    with pytest.raises(DeclarationError) as caught:
        make()
    place = f"{make.__code__.co_filename}:{make.__code__.co_firstlineno}: "
    assert str(caught.value).startswith(place)
    return str(caught.value).removeprefix(place)


@asynccontextmanager
async def running_in(
    graph: Graph, domain: int, opened: Callable[[Node], object] = lambda _: None
) -> AsyncIterator[None]:
    """Run a node of a graph's network in another domain.

    Args:
        opened: Opens the node's endpoints.
    """
    context = Context(graph.network.session(asyncio.get_running_loop()), domain=domain, clock=graph.clock)
    node = Node("elsewhere")
    opened(node)
    await core_of(node).start(context)
    try:
        yield
    finally:
        await core_of(node).stop()
        await context.close()
