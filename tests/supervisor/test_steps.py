"""Steps: what a graph does once while it comes up."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from graphflow import Abort, Node, Param, Publisher, action, service
from graphflow.errors import (
    CallTimeout,
    EncodeError,
    GoalAborted,
    ParameterError,
    Place,
    RemoteError,
    ServiceUnavailable,
)
from graphflow.graph.plan import PlannedStep, StepKind
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from graphflow.msgs.rcl_interfaces.srv import DescribeParameters, SetParametersAtomically
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.supervisor.steps import StepRunner, keep_up, remark_on
from graphflow.testing import Graph
from tests.cases import slow
from tests.conftest import Machine
from tests.supervisor.running import nothing_is_left, write


@slow
@pytest.mark.real
@pytest.mark.parametrize(
    ("call", "expected"),
    [("/fails", "OSError: the disk is full"), ("/nowhere, type: std_srvs/srv/Trigger", "no node offers the service")],
)
def test_a_failed_step_stops_the_graph(machine: Machine, project: Path, call: str, expected: str) -> None:
    """The step and the reason are told, everything is stopped again, the exit code is 1."""
    text = f"nodes:\n  /f: {{class: nodes.lab:Fails}}\nsteps:\n  ask: {{after: /f, call: {call}, timeout: 1.0}}\n"
    up = machine.start("up", write(project, text), cwd=project)

    assert up.wait() == 1

    assert "step ask FAILED" in up.text
    assert expected in up.text
    nothing_is_left(machine, [])


@slow
@pytest.mark.real
def test_a_message_is_said_when_it_is_due(machine: Machine, project: Path) -> None:
    """In the folder of the start and in order, also after the end of a program."""
    text = (
        "nodes:\n  short: {command: [sh, -c, exit 0]}\n  /long: {command: [sleep, '60']}\n"
        "steps:\n  last: {log: it has ended, after: {short: exited}}\n  first: {log: it begins}\n"
    )
    up = machine.start("up", write(project, text), cwd=project)
    up.wait_for("it has ended")
    assert up.text.index("it begins") < up.text.index("it has ended")
    assert up.end() == 0


@slow
@pytest.mark.real
def test_a_step_may_stop_the_graph(machine: Machine, project: Path) -> None:
    """With its reason, and as if it had been asked for."""
    text = (
        "nodes:\n  /long: {command: [sleep, '60']}\n"
        "steps:\n  late: {delay: 0.1}\n  end: {shutdown: it is late, after: late}\n"
    )
    up = machine.start("up", write(project, text), cwd=project)
    assert up.wait() == 0
    assert "stopping (it is late)" in up.text


@slow
@pytest.mark.real
def test_a_graph_ends_after_its_last_step(machine: Machine, project: Path) -> None:
    """A delay keeps it up after its processes have ended."""
    text = (
        "nodes:\n  /short: {command: ['true']}\nsteps:\n  late: {delay: 0.3}\n  end: {log: it is late, after: late}\n"
    )
    up = machine.start("up", write(project, text), cwd=project)
    assert up.wait() == 0
    assert up.text.index("it is late") < up.text.index("has ended")


@slow
@pytest.mark.real
def test_a_launch_file_that_starts_no_process(machine: Machine, project: Path) -> None:
    """Ends with its last action."""
    text = """\
from launch import LaunchDescription
from launch.actions import LogInfo, TimerAction


def generate_launch_description():
    return LaunchDescription([TimerAction(period=0.3, actions=[LogInfo(msg="it is late")])])
"""
    launch = machine.start("launch", write(project, text, "late.launch.py"), cwd=project)
    assert launch.wait() == 0
    assert launch.text.index("it is late") < launch.text.index("has ended")


@slow
@pytest.mark.real
def test_a_launch_file_without_actions(machine: Machine, project: Path) -> None:
    """Is told so before it has ended, which it has at once."""
    text = "from launch import LaunchDescription\ndef generate_launch_description():\n    return LaunchDescription()\n"
    launch = machine.start("launch", write(project, text, "none.launch.py"), cwd=project)
    assert launch.wait() == 0
    assert launch.text.index("the launch description has no actions") < launch.text.index("has ended")


TYPE = "example_interfaces/srv/AddTwoInts"


class Adder(Node):
    @service(AddTwoInts, "/add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        if request.a < 0:
            raise ValueError("no debts")
        if request.a:
            await self.clock.sleep(request.a)
        return AddTwoInts.Response(sum=request.a + request.b)


class Robot(Node):
    """Has what steps can do something to."""

    rate = Param(1.0, gt=0.0)
    limits = Param([1.0, 2.0])
    pose = Publisher(AddTwoInts.Request, "/pose")

    @action(Fibonacci, "/count")
    async def count(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        if goal.request.order < 0:
            raise Abort("no such number")
        return Fibonacci.Result(sequence=list(range(goal.request.order)))


def deed(do: StepKind, target: str, timeout: float = 10.0, **request: Any) -> PlannedStep:
    place = Place("graph.yaml", 1, 1)
    return PlannedStep("ask", do, target, place, place, place, request, timeout=timeout)


def step(call: str = "/add", timeout: float = 10.0, **request: Any) -> PlannedStep:
    place = Place("graph.yaml", 1, 1)
    return PlannedStep("ask", "call", call, place, place, place, request, timeout=timeout)


@asynccontextmanager
async def runner(graph: Graph, types: dict[str, str]) -> AsyncIterator[StepRunner]:
    """A runner of steps, in a process of its own."""
    await graph.start(supervisor := Node("_supervisor"))
    made = StepRunner(supervisor.context, types)
    yield made
    await made.close()


@pytest.mark.parametrize("types", [{"ask": TYPE}, {}], ids=["told by the plan", "found in the graph"])
async def test_a_step_is_a_call(graph: Graph, types: dict[str, str]) -> None:
    """Of the type that the plan's classes tell, or that the server announces; once is as good as twice."""
    await graph.start(Adder())
    async with runner(graph, types) as steps:
        for b in (5, 6):
            answer: Any = await steps.run(step(a=0, b=b))
            assert answer.sum == b


@pytest.mark.parametrize("types", [{"ask": TYPE}, {}], ids=["told by the plan", "found in the graph"])
async def test_a_server_may_come_later(graph: Graph, types: dict[str, str]) -> None:
    """It is waited for."""
    async with runner(graph, types) as steps:
        running = asyncio.ensure_future(steps.run(step(b=5)))
        await graph.clock.advance(9.0)
        await graph.start(Adder())
        answer: Any = await running
        assert answer.sum == 5


@pytest.mark.parametrize("types", [{"ask": TYPE}, {}], ids=["told by the plan", "found in the graph"])
async def test_a_server_that_never_comes(graph: Graph, types: dict[str, str]) -> None:
    """It is waited for as long as the step says."""
    async with runner(graph, types) as steps:
        running = asyncio.ensure_future(steps.run(step(timeout=3.0)))
        await graph.clock.advance(2.9)
        assert not running.done()
        await graph.clock.advance(0.2)
        with pytest.raises(ServiceUnavailable, match="/add"):
            await running


async def test_an_answer_that_comes_too_late(graph: Graph) -> None:
    """The call has as long as the step says."""
    await graph.start(Adder())
    async with runner(graph, {}) as steps:
        running = asyncio.ensure_future(steps.run(step(timeout=3.0, a=5)))
        await graph.clock.advance(3.1)
        with pytest.raises(CallTimeout):
            await running


@pytest.mark.parametrize(
    ("request_", "error", "text"),
    [({"a": "x"}, EncodeError, "expected int64"), ({"c": 1}, EncodeError, "c"), ({"a": -1}, RemoteError, "no debts")],
)
async def test_a_request_that_fails(graph: Graph, request_: dict[str, Any], error: type[Exception], text: str) -> None:
    """It does not fit the type, or the server has none of it."""
    await graph.start(Adder())
    async with runner(graph, {}) as steps:
        with pytest.raises(error, match=text):
            await steps.run(step(**request_))


async def test_it_is_hidden_and_leaves(graph: Graph) -> None:
    """Its node is not listed, and is gone when it is closed; one that made no call has none."""
    await graph.start(adder := Adder())
    cache = adder.context.cache
    async with runner(graph, {}) as steps:
        before = cache.nodes()
        await steps.run(step())
        await graph.settle()
        assert len(cache.nodes()) == len(before) + 1
        assert cache.nodes(hidden=False) == ["/adder"]
    await graph.settle()
    assert cache.nodes() == before


async def test_parameters_are_set(graph: Graph) -> None:
    """All of them or none; a whole number will do for a parameter that is not one, also in a list."""
    await graph.start(robot := Robot())
    async with runner(graph, {}) as steps:
        assert await steps.run(deed("set", "/robot", rate=3, limits=[1, 2.5])) == "rate = 3, limits = [1, 2.5]"
        assert (robot.rate, list(robot.limits)) == (3.0, [1.0, 2.5])
        with pytest.raises(ParameterError, match="rate"):
            await steps.run(deed("set", "/robot", limits=[9.0, 9.0], rate=-1.0))
        assert (robot.rate, list(robot.limits)) == (3.0, [1.0, 2.5])


class Strict(Node):
    """Answers for parameters as a node of ROS's does, which takes no whole number for one that is not."""

    def __init__(self) -> None:
        super().__init__("strict", start_parameter_services=False)
        self.types: list[int] = []

    @service(DescribeParameters, "~/describe_parameters")
    def describe(self, request: DescribeParameters.Request) -> DescribeParameters.Response:
        known = {"rate": 3, "limits": 8, "count": 2, "names": 9}
        return DescribeParameters.Response(
            descriptors=[ParameterDescriptor(name=n, type=known[n]) for n in request.names]
        )

    @service(SetParametersAtomically, "~/set_parameters_atomically")
    def set(self, request: SetParametersAtomically.Request) -> SetParametersAtomically.Response:
        self.types = [parameter.value.type for parameter in request.parameters]
        return SetParametersAtomically.Response(result=SetParametersResult(successful=True))


async def test_parameters_of_a_strict_node(graph: Graph) -> None:
    """Values are sent as the types that the node has declared; an empty list shows none of its own."""
    await graph.start(strict := Strict())
    async with runner(graph, {}) as steps:
        await steps.run(deed("set", "/strict", rate=3, limits=[1, 2.5], count=3, names=[]))
    assert strict.types == [3, 8, 2, 9]


@pytest.mark.parametrize("types", [{"ask": "example_interfaces/Fibonacci"}, {}], ids=["told by the plan", "found"])
async def test_a_goal_to_its_end(graph: Graph, types: dict[str, str]) -> None:
    """Its result, or why there is none; an action that nobody serves is waited for."""
    async with runner(graph, types) as steps:
        running = asyncio.ensure_future(steps.run(deed("goal", "/count", order=3)))
        await graph.clock.advance(2.0)
        await graph.start(Robot())
        result: Any = await running
        assert list(result.sequence) == [0, 1, 2]
        with pytest.raises(GoalAborted, match="no such number"):
            await steps.run(deed("goal", "/count", order=-1))
        running = asyncio.ensure_future(steps.run(deed("goal", "/nobodys", timeout=1.0)))
        await graph.clock.advance(1.1)
        with pytest.raises(ServiceUnavailable, match="/nobodys"):
            await running


@pytest.mark.parametrize(
    ("do", "target", "end"),
    [
        ("call", "/count", "; it is an action: goal: /count"),
        ("call", "/pose", "; it is a topic, of type "),
        ("call", "/robot/get_parametrs", "; did you mean '/robot/get_parameters'"),
        ("goal", "/robot/get_parameters", "; it is a service: call: /robot/get_parameters"),
        ("goal", "/cont", "; did you mean '/count'"),
    ],
)
async def test_a_target_of_another_kind(graph: Graph, do: StepKind, target: str, end: str) -> None:
    """The error gives the kind of the target, with the key for it."""
    await graph.start(Robot())
    async with runner(graph, {}) as steps:
        running = asyncio.ensure_future(steps.run(deed(do, target, timeout=1.0)))
        await graph.clock.advance(1.1)
        with pytest.raises(ServiceUnavailable, match=end):
            await running


@pytest.mark.parametrize(
    ("target", "what"),
    [("/robot", "node"), ("/pose", "topic"), ("/count", "action"), ("/robot/get_parameters", "service")],
)
async def test_a_wait(graph: Graph, target: str, what: str) -> None:
    """Until it is there, whatever it is; not longer than the step says, and then with the nearest name."""
    async with runner(graph, {}) as steps:
        running = asyncio.ensure_future(steps.run(deed("wait", target)))
        await graph.clock.advance(2.0)
        assert not running.done()
        await graph.start(Robot())
        assert await running == f"the {what} is there"
        running = asyncio.ensure_future(steps.run(deed("wait", "/robt", timeout=1.0)))
        await graph.clock.advance(1.1)
        with pytest.raises(ServiceUnavailable, match="/robt after 1 s; did you mean '/robot'"):
            await running


async def test_a_delay(graph: Graph) -> None:
    """So many seconds, and nothing else."""
    async with runner(graph, {}) as steps:
        running = asyncio.ensure_future(steps.run(deed("delay", "2 s", timeout=2.0)))
        await graph.clock.advance(1.9)
        assert not running.done()
        await graph.clock.advance(0.2)
        assert await running == "over"


@pytest.mark.parametrize(
    ("running", "has_processes", "keeps"), [("a", True, True), ("b", True, False), ("b", False, True)]
)
def test_steps_that_keep_a_graph_up(running: str, has_processes: bool, keeps: bool) -> None:
    """A delay does after the last process; a call may wait for a node that has ended, unless there never was one."""
    place = Place("g.yaml")
    steps = [PlannedStep("a", "delay", "", place, place, place), PlannedStep("b", "call", "/b", place, place, place)]
    assert keep_up(steps, [f"step {running}"], has_processes=has_processes) is keeps
    assert not keep_up(steps, [], has_processes=has_processes)


def test_an_empty_response() -> None:
    """A server that refuses a request often answers so, and logs why; a response without fields is always empty."""
    assert remark_on(AddTwoInts.Response()) == ", an empty response: the server's log may say why"
    for answer in (AddTwoInts.Response(sum=1), Empty.Response(), "over"):
        assert remark_on(answer) == ""
