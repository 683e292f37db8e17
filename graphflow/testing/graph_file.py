"""A graph file in a test: its nodes and steps in the file's order, on the test's network and clock."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Mapping
from pathlib import Path

import yaml

from graphflow.errors import GraphflowError
from graphflow.graph.plan import Plan, PlannedNode, PlannedStep
from graphflow.graph.resolve import load
from graphflow.names import did_you_mean
from graphflow.runtime.context import Context
from graphflow.runtime.node import Node
from graphflow.supervisor.launching.classes import add_root
from graphflow.supervisor.processes.worker import make_node
from graphflow.supervisor.steps import StepRunner


def plan_of(file: str | Path, arguments: Mapping[str, object]) -> Plan:
    """Resolve a graph file.

    Raises:
        GraphFileError: The file has mistakes, or an argument is not declared.
        GraphflowError: It has a program, which cannot run in a test.
    """
    given = [f"{name}:={value if isinstance(value, str) else _as_yaml(value)}" for name, value in arguments.items()]
    plan = load(Path(file), given)
    for node in plan.nodes:
        if node.command:
            text = f"{node.name} is a program ({node.what}), which cannot run in a test; leave it out by an `if:`"
            raise GraphflowError(f"{node.place}: {text}")
    return plan


def _as_yaml(value: object) -> str:
    text: str = yaml.safe_dump(value, default_flow_style=True, width=10**6)
    return text.removesuffix("\n...\n").rstrip("\n")


class NodesByName(dict[str, Node]):
    """Nodes by full name."""

    def __missing__(self, name: str) -> Node:
        """Raise KeyError with the names that there are."""
        raise KeyError(f"no node {name!r} has been started{did_you_mean(str(name), self)}")


class PlanRun:
    """A plan under way: each node and step begins when those that it comes after are ready, done or at their end.

    Args:
        context: Makes a context for the steps.
        start: Starts a node.
        failed: Takes the error of a node or step.
    """

    def __init__(
        self,
        plan: Plan,
        context: Callable[[], Context],
        start: Callable[[Node], Coroutine[object, object, None]],
        failed: Callable[[BaseException], None],
    ) -> None:
        self._plan, self._start, self._failed = plan, start, failed
        self.nodes = NodesByName()
        """The nodes that have been made, by full name."""
        self._met: dict[tuple[str, str], asyncio.Event] = {}
        self._steps = StepRunner(context(), {}) if plan.steps else None
        self._tasks: list[asyncio.Task[None]] = []

    def begin(self) -> None:
        """Begin with everything that comes after nothing."""
        add_root(self._plan.root)
        items: list[PlannedNode | PlannedStep] = [*self._plan.nodes, *self._plan.steps]
        for item in items:
            work = self._run_node(item) if isinstance(item, PlannedNode) else self._run_step(item)
            task = asyncio.ensure_future(work)
            task.add_done_callback(self._ended)
            self._tasks.append(task)

    def _ended(self, task: asyncio.Task[None]) -> None:
        if not task.cancelled() and (error := task.exception()) is not None:
            self._failed(error)

    def _event(self, name: str, condition: str) -> asyncio.Event:
        return self._met.setdefault((name, condition), asyncio.Event())

    async def _predecessors(self, item: PlannedNode | PlannedStep) -> None:
        for name, condition in item.after.items():
            await self._event(name, condition).wait()

    async def _run_node(self, planned: PlannedNode) -> None:
        await self._predecessors(planned)
        node = self.nodes[planned.name] = make_node(planned, self._plan.file)
        await self._start(node)
        self._event(planned.name, "ready").set()
        if any((planned.name, "exited") == need for need in self._met):
            await node.wait_ended()
            self._event(planned.name, "exited").set()

    async def _run_step(self, step: PlannedStep) -> None:
        assert self._steps is not None
        await self._predecessors(step)
        await self._steps.run(step)
        self._event(step.name, "done").set()

    async def close(self) -> None:
        """End what still waits."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        if self._steps is not None:
            await self._steps.close()
