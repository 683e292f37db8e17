"""Advice on Python's own errors; `docs/mistakes.md` has the complete texts."""

from __future__ import annotations

import asyncio
import linecache
import re
from asyncio import InvalidStateError
from typing import Any

import pytest

from graphflow import Node, Param
from graphflow.msgs.std_msgs.msg import UInt8MultiArray
from graphflow.runtime.mistakes.errors.python_errors import OF_VALUES, REMARKS, remark_on

NODE: Any = Node("n")


def caught(use: Any) -> BaseException:
    with pytest.raises((TypeError, AttributeError, RuntimeError, ValueError, KeyError, InvalidStateError)) as error:
        use()
    return error.value


@pytest.mark.parametrize("row", [*REMARKS, *OF_VALUES], ids=lambda row: row.text)
def test_groups_that_are_named(row: Any) -> None:
    """A remark uses only groups that one of its patterns has, so that it can always be written."""
    known = {*re.compile(row.text).groupindex, *re.compile(row.line).groupindex}
    assert {*re.findall(r"{(\w+)}", row.remark)} <= known


PUBLISH, TICK = "publish returns at once: remove await", "call it: await tick()"
GROUP = "handlers name the group that they share: @timer(1.0, group=motion)"
SEND = "write send instead of send_goal: async with client.send(goal) as sent:"
FEEDBACK = "iterate over it: async for item in ....feedback(...)"
RESULT = "wait for it first: result = await g.result()"
HEARD, WITH = "iterate over the messages: async for message in self.heard", "write async with"
LOG = 'a logger has a method for each level: write self.log.info("...")'
NO_HANDLER = (
    "messages are read from a Subscription(Type, topic) in the body of the class, not from their handler; an async "
    "generator is called: self.moved(...)"
)
INFO = "the argument of a timer's handler is a TimerInfo: leave it out, and take other values from self or a Param"
EXPRESSION = "object {} can't be used in 'await' expression"


def remark_at(monkeypatch: pytest.MonkeyPatch, text: str, line: str) -> str:
    """Return the advice on a TypeError that a line raises."""
    monkeypatch.setattr(linecache, "getline", lambda *_: line)

    def use() -> None:
        raise TypeError(text)

    return remark_on(caught(use))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("Transform.of() takes from 3 to 4 positional arguments but 6 were given", "is one argument: (x, y, z)"),
        (
            "Transform.__init__() got an unexpected keyword argument 'rpy'",
            "write Transform.of(parent, child, (x, y, z),",
        ),
    ],
)
def test_transforms_from_numbers(monkeypatch: pytest.MonkeyPatch, text: str, told: str) -> None:
    """They are made by `Transform.of`."""
    assert told in remark_at(monkeypatch, text, "")


def test_a_result_before_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a future, and of a task, whose error has another text."""
    monkeypatch.setattr(linecache, "getline", lambda *_: "total = self.sent.result().sum")

    async def ask() -> list[str]:
        task = asyncio.ensure_future(asyncio.sleep(0.0))
        told = [remark_on(caught(waits.result)) for waits in (task.get_loop().create_future(), task)]
        await task
        return told

    assert asyncio.run(ask()) == ["self.sent is still at work: write await self.sent, which returns its result"] * 2


def test_a_task_before_the_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is the node's, and starts with it."""
    monkeypatch.setattr(linecache, "getline", lambda *_: "asyncio.create_task(self.report())")

    def use() -> None:
        raise RuntimeError("no running event loop")

    assert remark_on(caught(use)) == (
        "no loop runs while a node is made: write @task above report, or self.spawn(self.report) in on_start"
    )


@pytest.mark.parametrize(
    ("text", "line", "remark"),
    [
        (EXPRESSION.format("NoneType"), "await self.words.publish(String())", PUBLISH),
        (EXPRESSION.format("NoneType"), "await time.sleep(0.1)", "write await self.clock.sleep(0.1)"),
        ("'NoneType' object can't be awaited", "await sleep(1 / 2)", "write await self.clock.sleep(1 / 2)"),
        ("'NoneType' object can't be awaited", "await self.words.publish(String())", PUBLISH),
        (EXPRESSION.format("method"), "await self.tick", TICK),
        ("'method' object can't be awaited", "await self.tick", TICK),
        (
            EXPRESSION.format("int"),
            "x = await self.compute(3)",
            "compute is not an `async def` and returns at once: remove await",
        ),
        (
            "'float' object can't be awaited",
            "await total(3)",
            "total is not an `async def` and returns at once: remove await",
        ),
        (EXPRESSION.format("TopicSubscription"), "message = await self.heard", HEARD),
        ("'TopicSubscription' object can't be awaited", "message = await self.heard", HEARD),
        (
            EXPRESSION.format("async_generator"),
            "await sent.feedback()",
            "iterate over it: async for item in ....feedback(...)",
        ),
    ],
)
def test_what_is_awaited(monkeypatch: pytest.MonkeyPatch, text: str, line: str, remark: str) -> None:
    """Python 3.14 words some errors differently."""
    assert remark_at(monkeypatch, text, line) == remark


@pytest.mark.parametrize(
    ("text", "line", "remark"),
    [
        (
            "'AddTwoInts_Response' object is not subscriptable",
            'print(r["sum"])',
            "the fields of a message are attributes: write r.sum",
        ),
        ("'NoneType' object is not subscriptable", 'print(r["sum"])', ""),
        (
            "unsupported operand type(s) for -: 'Time' and 'int'",
            "dt = self.clock.now() - self.last",
            "self.last is a number: initialize it by self.last = self.clock.now(), or write a time span as "
            "Duration.of(self.last)",
        ),
        ("unsupported operand type(s) for ^: 'float' and 'float'", "d = x^2.0", "a power is written with **"),
        ("unsupported operand type(s) for ^=: 'int' and 'float'", "n ^= x", "a power is written with **"),
        ("unsupported operand type(s) for ^: 'set' and 'int'", "s ^ 2", ""),
        ("unsupported operand type(s) for *: 'TimerInfo' and 'float'", "speed * 2.0", INFO),
        ("'<' not supported between instances of 'float' and 'TimerInfo'", "0.0 < speed", INFO),
        ("must be real number, not TimerInfo", "math.sin(speed)", INFO),
        ("float() argument must be a string or a real number, not 'TimerInfo'", "float(speed)", INFO),
    ],
)
def test_operands(monkeypatch: pytest.MonkeyPatch, text: str, line: str, remark: str) -> None:
    """Of messages, times, powers and what a timer gives."""
    assert remark_at(monkeypatch, text, line) == remark


@pytest.mark.parametrize(
    ("text", "line", "remark"),
    [
        ("'X' object does not support the context manager protocol", "with self.clock.timeout(1.0):", WITH),
        ("'HandlerGroup' object does not support the context manager protocol", "with self.motion:", GROUP),
        ("'HandlerGroup' object does not support the asynchronous context", "async with self.motion:", GROUP),
        ("'Group' object does not support the asynchronous context manager", "async with self.motion:", GROUP),
        (
            "object ClientGoalHandle can't be used in 'await' expression",
            "result = await sent",
            "that is the goal at the server: write await sent.result()",
        ),
        ("'HandlerGroup' object has no attribute 'acquire'", "await self.motion.acquire()", GROUP),
        (
            "'async for' requires an object with __aiter__ method, got Subscription",
            "async for n in self.scan:",
            "a Subscription is declared in the body of the class: scan = Subscription(...)",
        ),
        (
            "'coroutine' object does not support the asynchronous context manager protocol",
            "async with self.fib.send_goal(goal) as sent:",
            SEND,
        ),
        ("'ClientGoalHandle' object does not support the asynchronous context manager", "async with await x:", SEND),
        (
            "'async for' requires an object with __aiter__ method, got method",
            "async for f in g.feedback:",
            "call it: g.feedback(...)",
        ),
        ("'async for' requires an object with __aiter__ method, got method", "async for p in self.moved:", NO_HANDLER),
    ],
)
def test_with_and_for(monkeypatch: pytest.MonkeyPatch, text: str, line: str, remark: str) -> None:
    """The same mistake is known in the words of several versions of Python."""
    assert remark_at(monkeypatch, text, line) == remark


@pytest.mark.parametrize(
    ("text", "line", "remark"),
    [
        (
            "ServedGoal.feedback() got an unexpected keyword argument 'elapsed'",
            "goal.feedback(elapsed=1.0)",
            "it takes a message: write goal.feedback(ACTION.Feedback(elapsed=...))",
        ),
        (
            "'Transforms' object has no attribute 'lookup'",
            'found = await self.tf.lookup("odom", "base_link")',
            "a Transforms is declared in the body of the class: tf = Transforms(...)",
        ),
        (
            "'Publisher' object has no attribute 'publish'",
            "words.publish(Int32(data=self.count))",
            "a Publisher is declared in the body of the class: words = Publisher(...)",
        ),
        (
            "'function' object has no attribute 'sum'",
            "print(g.result.sum)",
            "wait for it first: result = await g.result()",
        ),
        ("'float' object has no attribute 'value'", "print(message.speed.value)", ""),
        ("'NodeLogger' object is not callable", 'self.log("x")', LOG),
        ("'TopicPublisher' object is not callable", "self.words(message)", "write self.words.publish(message)"),
        ("'ServiceClient' object is not callable", "await self.add(r)", "write await self.add.call(request)"),
        ("'float' object is not callable", "print(self.rate())", "self.rate is a value: remove the parentheses"),
    ],
)
def test_calls_and_attributes(monkeypatch: pytest.MonkeyPatch, text: str, line: str, remark: str) -> None:
    """Arguments and results of calls, and what is called itself."""
    assert remark_at(monkeypatch, text, line) == remark


@pytest.mark.parametrize(
    ("use", "remark"),
    [
        (lambda: UInt8MultiArray.from_bytes(UInt8MultiArray(data=[1, 2]).to_bytes()).data.__setitem__(0, 3), "a copy"),
        (lambda: UInt8MultiArray.from_bytes(UInt8MultiArray(data=[1, 2]).to_bytes()).data.__imul__(2), "data.copy()"),
        (lambda: UInt8MultiArray.from_bytes(UInt8MultiArray(data=[1, 2]).to_bytes()).data.sort(), "data.copy()"),
        (lambda: bool(UInt8MultiArray(data=[1, 2]).data), "len(...) > 0"),
        (lambda: UInt8MultiArray().data.append(1), "fill a list"),  # type: ignore[attr-defined]
    ],
)
def test_arrays(use: Any, remark: str) -> None:
    """numpy's errors, in terms of messages."""
    assert remark in remark_on(caught(use))


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("d = math.hypot(9 - self.pose.x, 9 - self.pose.y)", "pose"),
        ("self.log.info('%f', self.pose.x)", "pose"),
        ("self.log.info('%f', pose.x)", ""),
        ("print(self.pose.position.x)", ""),
    ],
)
def test_a_value_that_is_none(monkeypatch: pytest.MonkeyPatch, line: str, name: str) -> None:
    """It is named, rather than another attribute of the line."""
    monkeypatch.setattr(linecache, "getline", lambda *_: line)
    nothing: Any = None
    remark = remark_on(caught(lambda: nothing.x))
    assert remark == (
        f"self.{name} is None until something sets it: write if self.{name} is None: return" if name else ""
    )


def test_a_timer_method_is_no_handle(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is made by hand where it shall be cancelled."""
    monkeypatch.setattr(linecache, "getline", lambda *_: "self.tick.cancel()")
    assert "self.create_timer(period, self.tick)" in remark_on(caught(lambda: caught.cancel()))  # type: ignore[attr-defined]


def test_a_period_from_a_parameter() -> None:
    """It has no value in the class body."""
    assert "@timer(hz=rate)" in remark_on(caught(lambda: 1 / Param(1.0)))  # type: ignore[operator]


@pytest.mark.parametrize(
    "use",
    [
        lambda: NODE.parameters.get("x"),
        lambda: (1.0).value,  # type: ignore[attr-defined]
        lambda: dict[str, int]()["x"],
        lambda: asyncio.run(1),  # type: ignore[arg-type]
        lambda: int(None),  # type: ignore[call-overload]
    ],
)
def test_other_errors(use: Any) -> None:
    """Errors unrelated to nodes get no advice."""
    assert remark_on(caught(use)) == ""
