"""Declarations of methods by decorators."""

from __future__ import annotations

import asyncio
import inspect
from collections.abc import AsyncIterator, Callable, Iterator
from typing import Any, cast

import pytest

from graphflow import DeclarationError, Group, Node, Param, Qos, TimerInfo, action, service, subscription, task, timer
from graphflow.msgs.base import Message
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.msgs.std_srvs.srv import Trigger
from graphflow.runtime.declarations.handlers import Rate
from graphflow.testing import Graph
from tests.runtime.cast import anything, names_of, refusal_of


async def of_self(self: Any) -> None: ...
async def of_two(self: Any, one: Any) -> None: ...
async def of_three(self: Any, one: Any, two: Any) -> None: ...
async def of_none() -> None: ...
def plain(self: Any) -> None: ...
def plain_of_two(self: Any, one: Any) -> None: ...


def of_four(self: Any, one: Any, two: Any, three: Any) -> None:
    """Take three arguments too many."""


def generates(self: Any, one: Any) -> Iterator[int]:
    yield 1


async def generates_later(self: Any, one: Any) -> AsyncIterator[int]:
    yield 1


# One mistake a line: the error is to name that line.
# fmt: off
MISTAKES: list[tuple[Callable[[], object], str]] = [
    (lambda: subscription(anything("chatter"), anything(String)), "@subscription needs a message class, not 'chatter'"),
    (lambda: subscription(String, "a-b"), "@subscription: 'a-b' is not a topic or service name"),
    (lambda: subscription(String, "x", depth=-2), "a queue depth cannot be -2"),
    (lambda: subscription(String, "x", group=anything("io")), "group= takes a Group, not 'io'"),
    (lambda: subscription(String, "x", group=anything(Group)), "group= takes a Group, not <class"),
    (lambda: timer(0.1, group=anything(1)), "group= takes a Group, not 1"),
    (lambda: service(AddTwoInts, "x", group=anything(1)), "group= takes a Group, not 1"),
    (lambda: anything(timer)(1.0, anything), "self.create_timer(1.0, self.anything), or @timer(1.0) above anything"),
    (lambda: timer(), "@timer: give either a period in seconds or hz="),
    (lambda: timer(0.1, hz=10), "@timer: give either a period in seconds or hz="),
    (lambda: timer(0.0), "@timer: a period must be a positive number, not 0.0"),
    (lambda: timer(hz=-1), "@timer: hz must be a positive number, not -1"),
    (lambda: timer(anything("fast")), "@timer: a period or frequency is a number or a Param, not 'fast'"),
    (lambda: timer(hz=Param(0.0)), "@timer: hz must be a positive number, not 0.0"),
    (lambda: timer(hz=anything(Param("often"))), "@timer: could not convert string to float: 'often'"),
    (lambda: timer(anything(of_self)), "write @timer(0.5) or @timer(hz=2.0), with a period"),
    (lambda: service(anything(String), "x"), "@service needs a service class, not <class"),
    (lambda: service(anything(AddTwoInts.Response), "x"), "give the service's class, as in AddTwoInts"),
    (lambda: service(AddTwoInts, "x y"), "@service: 'x y' is not a topic or service name"),
    (lambda: task(anything(plain)), "@task goes on an `async def` method, without parentheses"),
    (lambda: task(of_two), "of_two must take self, not (self, one)"),
    (lambda: subscription(String, "x")(of_self), "of_self must take self and one argument or self and two arguments"),
    (lambda: subscription(String, "x")(of_four), "of_four must take self and one argument or self and two"),
    (lambda: service(AddTwoInts, "x")(of_four), "of_four must take self and one argument or self and two arguments"),
    (lambda: subscription(String, "x", on_event=anything("heard")), "@subscription: on_event= takes a method def"),
    (lambda: subscription(String, "x", thread=True)(of_two), "of_two: thread=True is for `def`, an `async def` runs"),
    (lambda: subscription(String, "x")(anything(staticmethod(of_self))), "@subscription goes on a method, not on <s"),
    (lambda: subscription(String, "x")(anything(String)), "@subscription goes on a method, not on <class"),
    (lambda: subscription(String, "x")(generates), "generates contains yield, so its body would never run"),
    (lambda: subscription(String, "x")(generates_later), "generates_later contains yield"),
    (lambda: timer(0.1)(of_none), "of_none must take self or self and one argument, not ()"),
    (lambda: timer(0.1)(of_three), "of_three must take self or self and one argument, not (self, one, two)"),
    (lambda: service(AddTwoInts, "x")(plain),
     "plain must take self and one argument or self and two arguments, not (self)"),
    (lambda: timer(0.2)(timer(0.1)(lambda self: None)), "<lambda> is declared twice, as @timer"),
    (lambda: subscription(String, "x", Qos(), depth=5), "give a Qos or a depth, not both: Qos(depth=5"),
    (lambda: subscription(String, "x", on_error=anything("shrug")),
     "on_error must be one of budget, log, end, not 'shrug'"),
    (lambda: timer(1.0, on_error=anything("shrug")), "on_error must be one of budget, log, end, not 'shrug'"),
    (lambda: action(anything(AddTwoInts), "x"), "@action needs an action class, not <class"),
    (lambda: action(Fibonacci, "x", policy=anything("push")), "policy must be one of reject, queue, preempt, parallel"),
    (lambda: action(Fibonacci, "x", on_client_loss=anything("weep")), "on_client_loss must be one of continue, cancel"),
    (lambda: action(Fibonacci, "x", accept=anything("all")), "@action: accept= takes a method defined above"),
    (lambda: action(Fibonacci, "x", cancellable=anything(1)), "@action: cancellable= takes a method"),
    (lambda: action(Fibonacci, "x", cleanup_timeout=0.0), "cleanup_timeout must be more than 0 seconds, not 0.0"),
    (lambda: cast(Any, task)(thread=True), "task has no thread=; put what blocks into await self.offload"),
    (lambda: action(Fibonacci, "x", thread=True)(of_two), "of_two: thread=True is for `def`, an `async def` runs"),
]
# fmt: on


@pytest.mark.parametrize(("make", "text"), MISTAKES, ids=[text[:50] for _, text in MISTAKES])
def test_a_wrong_handler_names_its_place(make: Callable[[], object], text: str) -> None:
    """The error has file, line and the correct form."""
    assert text in refusal_of(make)


def test_decorators_return_the_function() -> None:
    """A handler can be called as if it were not one."""

    async def handler(self: Any, message: Any) -> None: ...

    assert subscription(String, "x")(handler) is handler
    assert inspect.iscoroutinefunction(handler)


def test_optional_arguments_do_not_count() -> None:
    """A handler may have more arguments that need not be given."""

    class Lenient(Node):
        @subscription(String, "x")
        async def heard(self, message: String, loudly: bool = False) -> None: ...

        @timer(1.0)
        async def tick(self, extra: int = 0) -> None: ...

    assert names_of(Lenient.interface()) == ("heard", "tick")


async def test_a_timer_may_take_info_or_not(graph: Graph) -> None:
    """Its signature decides."""
    seen: list[Any] = []
    done = asyncio.Event()
    loop = asyncio.get_running_loop()

    class Timers(Node):
        @timer(1.0)
        async def without(self) -> None:
            seen.append(None)

        @timer(1.0)
        def with_info(self, info: TimerInfo) -> None:
            seen.append(info)

        @timer(1.0, thread=True)
        def in_thread(self, info: TimerInfo) -> None:
            seen.append(info)
            loop.call_soon_threadsafe(done.set)

    await graph.start(Timers())
    await graph.clock.advance(1.0)
    await done.wait()

    info = TimerInfo(1_000_000_000, 1_000_000_000, 0)
    assert sorted(map(str, seen)) == sorted(map(str, [None, info, info]))


async def test_one_decorator_may_stand_on_two_methods(graph: Graph) -> None:
    """Each has a record of its own: its place, and whether it takes info."""
    every = timer(1.0)
    seen: list[Any] = []

    class Ticker(Node):
        @every
        def tick(self) -> None:
            seen.append("tick")

        @every
        def tock(self, info: TimerInfo) -> None:
            seen.append(info)

    tick, tock = Ticker.interface().handlers
    await graph.start(Ticker())
    await graph.clock.advance(1.0)

    assert tock.place.line == tick.place.line + 4
    assert seen == ["tick", TimerInfo(1_000_000_000, 1_000_000_000, 0)]


def test_a_rate_reads_its_parameter() -> None:
    """Its default when the class is made, its value when the node runs; a number is itself."""
    period, hz = Param(0.5, name="period"), Param(4, name="hz")

    assert Rate(0.5, None).period_ns() == 500_000_000
    assert Rate(period, None).parameters() == ["period"]
    assert (Rate(period, None).period_ns(), Rate(period, None).period_ns({"period": 2.0})) == (500_000_000, 2 * 10**9)
    assert (Rate(None, hz).period_ns(), Rate(None, hz).period_ns({"hz": 10})) == (250_000_000, 100_000_000)
    with pytest.raises(ValueError, match="hz must be a positive number, not 0"):
        Rate(None, hz).period_ns({"hz": 0})


def annotated(decorator: Any, annotation: Any, second: Any = None) -> None:
    """Decorate a handler whose arguments are annotated so."""

    async def handle(self: Any, given: Any) -> None: ...

    async def fill(self: Any, given: Any, response: Any) -> None: ...

    fn = handle if second is None else fill
    fn.__annotations__ |= {"given": annotation, "response": second}
    decorator(fn)


@pytest.mark.parametrize(
    ("decorator", "annotations", "told"),
    [
        (subscription(Int32, "i"), (String,), "handle is given Int32, and its argument 'given' is annotated String"),
        (subscription(Int32, "i"), ("String",), "handle is given Int32, and its argument 'given' is annotated String"),
        (service(Trigger, "s"), (Trigger.Response,), "given Trigger.Request, .* is annotated Trigger.Response"),
        (service(Trigger, "s"), (Trigger.Request, Int32), "given Trigger.Response, .*'response' is annotated Int32"),
        (action(Fibonacci, "a"), (Fibonacci.Goal,), "given Fibonacci.Handle, .* is annotated Fibonacci.Goal"),
    ],
)
def test_a_handler_that_is_annotated_for_another_type(decorator: Any, annotations: Any, told: str) -> None:
    """Is written for other messages than those that will come."""
    with pytest.raises(DeclarationError, match=told):
        annotated(decorator, *annotations)


@pytest.mark.parametrize("annotation", [Int32, "Int32", Message, Any, "Unknown", "Int32 | None", object, int])
def test_other_annotations_are_the_users_affair(annotation: Any) -> None:
    """Only a message class of another type is certain to be wrong."""
    annotated(subscription(Int32, "i"), annotation)


def test_a_callback_of_another_type() -> None:
    """A method that is passed is compared as a declared one; any other callable is not."""

    class Heard(Node):
        def strings(self, message: String) -> None: ...

        def numbers(self, message: Int32) -> None: ...

    node = Heard("heard")
    node.create_subscription(Int32, "i", node.numbers)
    node.create_subscription(Int32, "j", lambda message: None)
    with pytest.raises(DeclarationError, match=r"strings is given Int32, .*'message' is annotated String"):
        node.create_subscription(Int32, "k", node.strings)  # type: ignore[arg-type]
