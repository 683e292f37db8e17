"""Handlers that return something other than their response or result."""

from __future__ import annotations

import asyncio
import gc
import warnings
from collections.abc import Callable
from typing import Any

import pytest

from graphflow import Abort, Client, Node, RemoteError, action, service
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.runtime.mistakes.wrong_returns import wrong_return
from graphflow.testing import Graph
from tests.cases import slow


class Front(Node):
    """A service that passes its requests on, in several wrong ways, and in two right ones."""

    back = Client(AddTwoInts, "back")

    @service(AddTwoInts, "back")
    async def answer(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)

    @service(AddTwoInts, "unawaited")
    async def unawaited(self, request: AddTwoInts.Request) -> Any:
        if request.a < 0:
            return AddTwoInts.Response()
        return self.back.call(request)

    @service(AddTwoInts, "stored")
    async def stored(self, request: AddTwoInts.Request) -> Any:
        response = self.back.call(request)
        return response

    @service(AddTwoInts, "task")
    async def in_a_task(self, request: AddTwoInts.Request) -> Any:
        return asyncio.create_task(self.back.call(request))

    @service(AddTwoInts, "class")
    async def of_the_class(self, _: AddTwoInts.Request) -> Any:
        return AddTwoInts.Response

    @service(AddTwoInts, "awaited")
    async def awaited(self, request: AddTwoInts.Request) -> Any:
        return await self.back.call(request)

    @service(AddTwoInts, "plain")
    def plain(self, request: AddTwoInts.Request) -> Any:
        return self.back.call(request)

    @action(Fibonacci, "count")
    async def count(self, goal: Any) -> Any:
        return self.counted(goal)

    async def counted(self, goal: Any) -> Fibonacci.Result:
        return Fibonacci.Result(sequence=[goal.request.order])


def line_of(method: Callable[..., object], nth: int) -> str:
    return f"{__file__}:{method.__code__.co_firstlineno + nth}"


@slow
@pytest.mark.parametrize(
    ("name", "text"),
    [
        (
            "unawaited",
            "it returned self.back.call(request) without await: write return await self.back.call(request) "
            f"({line_of(Front.unawaited, 4)})",
        ),
        ("stored", "it returned the coroutine ServiceClient.call, not AddTwoInts.Response(...): write await"),
        ("task", "it returned the task, not AddTwoInts.Response(...): write await"),
        ("class", "it returned the class AddTwoInts.Response: write AddTwoInts.Response(...)"),
    ],
)
async def test_services(graph: Graph, caplog: pytest.LogCaptureFixture, name: str, text: str) -> None:
    """The error names the line and what to write there; Python's own warning does not repeat it."""
    await graph.start(Front())
    with pytest.raises(RemoteError) as caught, warnings.catch_warnings():
        warnings.simplefilter("error")
        await graph.call(AddTwoInts, f"/{name}", AddTwoInts.Request(a=1, b=2))
    gc.collect()
    assert caught.value.message.startswith(text)
    assert [
        record.getMessage().count("await") for record in caplog.records if "did nothing" in record.getMessage()
    ] == []


@pytest.mark.parametrize("name", ["awaited", "plain"])
async def test_right_ones(graph: Graph, name: str) -> None:
    """A `def` may return the coroutine that makes the response."""
    await graph.start(Front())
    assert (await graph.call(AddTwoInts, f"/{name}", AddTwoInts.Request(a=1, b=2))).sum == 3


def test_actions() -> None:
    """They are told in the same words."""
    front = Front()
    error = wrong_return(front.counted(None), Fibonacci.Result, front.count)
    assert str(error) == (
        "it returned self.counted(goal) without await: write return await self.counted(goal) "
        f"({line_of(Front.count, 2)})"
    )


def test_a_result_that_is_forgotten() -> None:
    """The place of the handler is told, with the statement that is missing."""
    code = Front.count.__code__
    text = str(wrong_return(None, Fibonacci.Result, Front().count))
    place = f"test_wrong_returns.py:{code.co_firstlineno}"
    assert text == f"it returned None: end it with return Fibonacci.Result(...) ({place})"
    text = str(wrong_return(None, Fibonacci.Result, Front().count, "front.py:7"))
    assert text.endswith("return Fibonacci.Result(...) (front.py:7)")


class Refusing(Node):
    @action(Fibonacci, "fibonacci")
    async def count(self, goal: Any) -> Any:
        return Abort("too large")


def test_an_error_that_is_returned() -> None:
    """It is to be raised, in its line."""
    error = wrong_return(Abort("too large"), Fibonacci.Result, Refusing().count)
    assert str(error) == f"it returned an exception: write raise Abort('too large') ({line_of(Refusing.count, 2)})"


def test_a_response_that_is_filled_in() -> None:
    """It is returned, too; a handler without one makes its own."""

    def add(request: object, response: object) -> None: ...

    def ask(request: object) -> None: ...

    assert str(wrong_return(None, AddTwoInts.Response, add, "x.py:1")) == (
        "it returned None: end it with return response (x.py:1)"
    )
    assert "return AddTwoInts.Response(...)" in str(wrong_return(None, AddTwoInts.Response, ask))
