"""Running nodes in a program of one's own, and until they end."""

from __future__ import annotations

import asyncio
import linecache
import sys
from contextlib import AsyncExitStack
from typing import Any
from unittest.mock import AsyncMock

import pytest

from graphflow import (
    Client,
    Context,
    ErrorBudget,
    GraphflowError,
    Node,
    Param,
    Publisher,
    Subscription,
    service,
    subscription,
    task,
    timer,
)
from graphflow.errors import ClosedError
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.args import parse_ros_args
from graphflow.runtime.ending import StopRequest
from graphflow.runtime.process_nodes import Company
from graphflow.runtime.run import _within_asyncio_run, make, run, running, serve
from graphflow.testing.clock import ManualClock, settle
from graphflow.transport.memory import Network


class Talker(Node):
    """Something to run."""

    rate = Param(1.0)
    out = Publisher(String, "out")


class Failing(Node):
    """Ends with an error after a second."""

    @task
    async def work(self) -> None:
        await self.clock.sleep(1.0)
        raise ValueError("broken")


class Breaking(Node):
    """Ends with an error at once."""

    @task
    async def work(self) -> None:
        raise ValueError("broken")


class Quitting(Node):
    """Ends itself after a second."""

    @timer(1.0)
    async def quit(self) -> None:
        self.shutdown()


def context_of(clock: ManualClock | None = None) -> Context:
    return Context(Network().session(asyncio.get_running_loop()), clock=clock or ManualClock())


# running


async def test_run_refuses_a_running_loop(graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a notebook or a test; the error has the correct form and the line."""
    begins = r"^\S+test_run\.py:\d+: graphflow\.run starts an event loop, but one is already running here; write "
    with pytest.raises(RuntimeError, match=rf"{begins}await graph\.start\(Talker\(\)\), with graph as an argument"):
        run(Talker)
    monkeypatch.delitem(sys.modules, "_pytest")
    with pytest.raises(RuntimeError, match=rf"{begins}async with graphflow\.running\(Talker\(\)\): \.\.\.$"):
        run(Talker)


def test_run_without_nodes(caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    """It ends at once, with the line of the call and the correct form."""
    monkeypatch.setattr(Context, "open", AsyncMock(return_value=AsyncMock()))
    monkeypatch.setattr("graphflow.runtime.run.serve", AsyncMock())
    run(args=[])
    assert caplog.messages[0].startswith(f"{__file__}:")
    assert caplog.messages[0].endswith(": graphflow.run was called without a node; write graphflow.run(Talker)")


async def test_nodes_run_for_the_length_of_the_block(graphflow_runner: asyncio.Runner) -> None:
    """They are up in it and stopped after it; a context that was given stays open."""
    one, two, context = Talker("one"), Talker("two"), context_of()
    async with running(one, two, context=context) as given:
        assert given is context
        assert one.is_running
        assert two.is_running
        one.out.publish(String())

    assert not one.is_running
    assert not two.is_running
    async with running(Talker(), context=context):
        await settle()
        assert context.cache.nodes() == ["/talker"]
    await context.close()


class Adder(Node):
    """A service that answers after a second."""

    @service(AddTwoInts, "add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        await self.clock.sleep(1.0)
        return AddTwoInts.Response()


class Using(Node):
    """Something to wait for in a task of the program's own."""

    add = Client(AddTwoInts, "add")
    missing = Client(AddTwoInts, "missing")
    heard = Subscription(String, "heard")
    out = Publisher(String, "out")

    async def read(self) -> None:
        async for _ in self.heard:
            pass


@pytest.mark.parametrize("is_own", [True, False], ids=["own", "given"])
async def test_nothing_waits_for_nodes_that_were_left(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch, is_own: bool
) -> None:
    """Tasks of the program get the error, whoever closes the context, and late arrivals are no error."""
    context, node, failures = context_of(), Using(), list[dict[str, Any]]()
    context.loop.set_exception_handler(lambda _, failure: failures.append(failure))
    if is_own:
        monkeypatch.setattr(Context, "open", AsyncMock(return_value=context))
    async with running(Adder(), node, context=None if is_own else context):
        await node.add.wait_ready()
        call = asyncio.create_task(node.add.call(AddTwoInts.Request(), timeout=None))
        await settle()
        late = asyncio.create_task(node.add.call(AddTwoInts.Request(), timeout=None))
        others = [asyncio.create_task(wait()) for wait in (node.missing.wait_ready, node.out.wait_matched, node.read)]
        await asyncio.sleep(0)
    if not is_own:
        await context.close()
    await settle()

    assert all(task.done() for task in (call, late, *others))
    ends = [type(task.exception()) for task in (call, late, *others)]
    assert ends == [ClosedError, ClosedError, ClosedError, ClosedError, type(None)]
    assert failures == []


async def test_an_error_of_the_block_leaves_it_as_it_is(graphflow_runner: asyncio.Runner) -> None:
    """Not wrapped in anything, and the nodes are stopped."""
    node, context = Talker(), context_of()
    error = ValueError("mine")
    with pytest.raises(ValueError, match="mine") as caught:
        async with running(node, context=context):
            raise error

    assert caught.value is error
    assert not node.is_running
    await context.close()


async def test_advice_on_an_error_of_the_block(graphflow_runner: asyncio.Runner) -> None:
    """A mistake in the use of a node's parts is explained as in its handlers."""
    context, node = context_of(), Node("reader")
    async with running(node, context=context):
        pass
    heard: Any = node.create_subscription(String, "chatter", None, 10)
    with pytest.raises(TypeError) as caught:
        async with running(Node("other"), context=context):
            await heard
    assert caught.value.__notes__ == ["iterate over the messages: async for message in heard"]
    await context.close()


async def test_a_nodes_failure_leaves_the_block(graphflow_runner: asyncio.Runner) -> None:
    """The block is cancelled where it waits, and the node's own error comes out of it."""
    clock = ManualClock()
    context, bystander, failing = context_of(clock), Talker(), Failing()
    log: list[str] = []

    async def program() -> None:
        async with running(bystander, failing, context=context):
            try:
                await asyncio.Event().wait()
            except asyncio.CancelledError:
                log.append("cancelled")
                raise

    block = asyncio.create_task(program())
    await clock.advance(1.0)

    with pytest.raises(ValueError, match="broken"):
        await block
    assert log == ["cancelled"]
    assert not bystander.is_running
    assert not failing.is_running
    await context.close()


async def test_a_nodes_failure_after_its_cell(
    graphflow_runner: asyncio.Runner, caplog: pytest.LogCaptureFixture
) -> None:
    """A notebook may enter the block in a cell that has ended: the error is logged, and the node stops."""
    clock = ManualClock()
    context, failing, stack = context_of(clock), Failing(), AsyncExitStack()
    await asyncio.create_task(stack.enter_async_context(running(failing, context=context)))
    await clock.advance(1.0)

    assert not failing.is_running
    assert [record.name for record in caplog.records if record.getMessage() == "broken"] == [failing.log.name]
    assert not [record for record in caplog.records if record.name == "asyncio"]
    await stack.aclose()
    await context.close()


async def test_failures_together(graphflow_runner: asyncio.Runner) -> None:
    """A node's failure and an error of the block's cleanup come out as a group: neither is lost."""
    clock = ManualClock()
    context = context_of(clock)

    async def program() -> None:
        async with running(Failing(), context=context):
            try:
                await asyncio.Event().wait()
            finally:
                raise KeyError("cleanup")

    block = asyncio.create_task(program())
    await clock.advance(1.0)

    with pytest.raises(ExceptionGroup) as caught:
        await block
    assert {type(e) for e in caught.value.exceptions} == {ValueError, KeyError}
    await context.close()


async def test_a_node_that_cannot_start(graphflow_runner: asyncio.Runner) -> None:
    """Its error comes out as it is, the block is not entered, and the others are stopped."""
    first, context = Talker("first"), context_of()
    with pytest.raises(GraphflowError, match="there is no parameter 'rat'"):
        async with running(first, Talker(rat=1), context=context):
            pytest.fail("entered")

    assert not first.is_running
    with pytest.raises(ClosedError):
        first.out.publish(String())
    await context.close()


async def test_a_node_that_ends_itself_leaves_the_block_alone(graphflow_runner: asyncio.Runner) -> None:
    """The block decides how long the graph lives."""
    clock = ManualClock()
    context, node = context_of(clock), Quitting()
    async with running(node, context=context):
        await clock.advance(2.0)
        assert node.is_running
    assert not node.is_running
    await context.close()


async def test_a_cancelled_block(graphflow_runner: asyncio.Runner) -> None:
    """Cancelling the program stops the nodes and is a cancellation outside too."""
    node, context = Talker(), context_of()

    async def program() -> None:
        async with running(node, context=context):
            await asyncio.Event().wait()

    block = asyncio.create_task(program())
    await settle()
    assert node.is_running
    block.cancel()
    await settle()

    assert block.cancelled()
    assert not node.is_running
    await context.close()


async def test_without_a_context_one_is_opened_and_closed(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also when a node cannot start."""
    closed: list[Context] = []

    class Opened(Context):
        @classmethod
        async def open(cls, *_: Any, **__: Any) -> Context:
            return cls(Network().session(asyncio.get_running_loop()))

        async def close(self) -> None:
            closed.append(self)
            await super().close()

    monkeypatch.setattr("graphflow.runtime.run.Context", Opened)
    async with running(Talker()) as context:
        assert closed == []
    assert closed == [context]
    with pytest.raises(GraphflowError):
        async with running(Talker(rat=1)):
            pytest.fail("entered")
    assert len(closed) == 2


# serve


async def serving(*nodes: Node, clock: ManualClock) -> tuple[asyncio.Task[None], StopRequest]:
    stop = StopRequest()
    task = asyncio.create_task(serve(nodes, context_of(clock), stop))
    await settle()
    return task, stop


async def test_serve_until_asked_to_stop(graphflow_runner: asyncio.Runner) -> None:
    """The nodes then stop without an error."""
    node, clock = Talker(), ManualClock()
    served, stop = await serving(node, clock=clock)
    assert node.is_running
    stop.set()
    await served

    assert not node.is_running


async def test_serve_until_all_have_ended(graphflow_runner: asyncio.Runner) -> None:
    """One that ends itself waits for the others."""
    first, second, clock = Quitting("first"), Talker(), ManualClock()
    served, _ = await serving(first, second, clock=clock)
    await clock.advance(2.0)
    assert not served.done()
    second.shutdown()
    await served

    assert not first.is_running


async def test_serve_until_one_fails(graphflow_runner: asyncio.Runner) -> None:
    """Its error comes out, and the others are stopped."""
    other, clock = Talker(), ManualClock()
    served, _ = await serving(other, Failing(), clock=clock)
    await clock.advance(1.0)

    with pytest.raises(ValueError, match="broken"):
        await served
    assert not other.is_running


async def test_serve_says_who_is_ready(graphflow_runner: asyncio.Runner) -> None:
    """Each node once it has started, in order; one that cannot start stops those before it."""
    ready: list[Node] = []
    first, wrong = Talker("first"), Talker("wrong", rat=1)
    with pytest.raises(GraphflowError, match="no parameter 'rat'"):
        await Company(context_of(), StopRequest(), ready.append).run([first, wrong])

    assert ready == [first]
    assert not first.is_running


async def test_serve_nobody(graphflow_runner: asyncio.Runner) -> None:
    """Without nodes it returns at once."""
    await serve([], context_of(), StopRequest())


async def test_serve_two_that_cannot_start(graphflow_runner: asyncio.Runner) -> None:
    """The error of one comes out, and that of the other is not left for the garbage collector to complain of."""
    with pytest.raises(GraphflowError, match="parameter 'rat"):
        await serve([Talker("one", rat=1), Talker("two", rate="x")], context_of(), StopRequest())


# make


def test_a_node_as_the_command_line_wants_it() -> None:
    """Names and parameters come from the words."""
    node = make(Talker, parse_ros_args(["-r", "out:=news", "-p", "rate:=3", "-r", "__ns:=/a"]))

    assert isinstance(node, Talker)
    assert node.full_name == "/a/talker"
    assert node.out.name == "/a/news"
    assert node.rate == 3.0
    assert node.parameters.source("rate") == "command line"


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        (["-p", "rate=3"], 2, "error: -p 'rate=3': write rate:=3"),
        (["--ros-args", "--log-level", "loud"], 2, "error: 'loud' is not a log level"),
        (["-p", "rate:=fast"], 2, "error: parameter 'rate' is of type double, 'fast' is not (from command line)"),
    ],
)
def test_run_says_what_is_wrong_with_its_words(
    capsys: pytest.CaptureFixture[str], words: list[str], code: int, text: str
) -> None:
    """Before anything is opened: a sentence and an exit code."""
    with pytest.raises(SystemExit) as caught:
        run(Talker, args=words)

    assert caught.value.code == code
    assert text in capsys.readouterr().err


class Plain:
    """A class without a base."""


def test_run_refuses_a_class_of_no_nodes(capsys: pytest.CaptureFixture[str]) -> None:
    """It shows the base class that is missing."""
    with pytest.raises(SystemExit) as caught:
        run(Plain, args=[])  # type: ignore[arg-type]
    assert caught.value.code == 2
    told = "error: Plain is not a class of nodes, which derive from Node: write class Plain(Node)"
    assert capsys.readouterr().err.startswith(told)


@pytest.mark.parametrize(("line", "is_told"), [("asyncio.run(run(Talker))", True), ("run(Talker)", False)])
def test_run_within_asyncio_run(monkeypatch: pytest.MonkeyPatch, line: str, is_told: bool) -> None:
    """There are two loops then, of which the second has nothing to run."""
    monkeypatch.setattr(linecache, "getline", lambda *_: line)
    told = _within_asyncio_run(sys._getframe())
    assert told.endswith("runs its own event loop, until the nodes end: leave out asyncio.run") is is_told
    assert _within_asyncio_run(None) == ""


class Storming(Node):
    """Fails at each word that it hears, which are two."""

    error_budget = ErrorBudget(1, per=10.0)
    out = Publisher(String, "words")

    @subscription(String, "words")
    async def heard(self, message: String) -> None:
        raise ValueError("bad")

    @task
    async def speak(self) -> None:
        for _ in range(2):
            self.out.publish(String())


@pytest.mark.parametrize(
    ("cls", "last"),
    [
        (Storming, "error: 2 handler errors within 10 s, the last in heard: ValueError: bad. The node ends; on_error="),
        (Breaking, ""),
    ],
)
def test_run_says_why_a_node_has_ended(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], cls: type[Node], last: str
) -> None:
    """Handlers' errors have been logged one by one; the exceeded budget is logged at the end."""

    async def opened() -> Context:
        return context_of()

    monkeypatch.setattr(Context, "open", opened)
    with pytest.raises(SystemExit) as caught:
        run(cls, args=[])

    assert caught.value.code == 1
    said = [line for line in capsys.readouterr().err.splitlines() if line.startswith("error: ")]
    assert [line[: len(last)] for line in said] == [last] * bool(last)
