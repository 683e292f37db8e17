"""Steps: actions of a graph that run once while it comes up."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Awaitable, Callable, Collection, Iterable
from typing import Any

from graphflow.errors import ParameterError, ServiceUnavailable
from graphflow.graph.plan import PlannedStep
from graphflow.interface import type_id
from graphflow.msgs import registry
from graphflow.msgs.base import Message
from graphflow.msgs.values import from_plain
from graphflow.names import did_you_mean
from graphflow.runtime.context import Context
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.wire.liveliness import Kind

_DOUBLE, _DOUBLES = 3, 8
"""Values of rcl_interfaces/msg/ParameterType."""


def remark_on(answer: object) -> str:
    """Return a remark on a response that is empty, as many servers answer what they refuse; else an empty text."""
    is_empty = isinstance(answer, Message) and bool(answer.SCHEMA.fields) and answer == type(answer)()
    return ", an empty response: the server's log may say why" if is_empty else ""


def keep_up(steps: Iterable[PlannedStep], running: Collection[str], *, has_processes: bool) -> bool:
    """Whether running steps keep a graph up whose processes have all ended: delays do, without processes all do.

    Args:
        running: Names of steps, as `step NAME`.
    """
    return any(f"step {step.name}" in running and (step.do == "delay" or not has_processes) for step in steps)


class StepRunner:
    """The steps of a graph, carried out by a hidden node of the supervisor.

    Args:
        types: Types of services and actions by step name, as far as the plan's classes declare them.
    """

    def __init__(self, context: Context, types: dict[str, str]) -> None:
        self._context = context
        self._types = types
        self._node: Node | None = None
        self._started: asyncio.Future[None]

    async def run(self, step: PlannedStep) -> object:
        """Carry out a step; returns its result.

        Raises:
            CallError: The service is unavailable, failed, or did not answer within the step's timeout.
            EncodeError: The request does not fit the type.
            ParameterError: The node refused a parameter.
            GoalError: The goal did not succeed.
        """
        if step.do in ("log", "shutdown"):
            return step.target
        node = await self.node()
        if step.do == "delay":
            await self._context.clock.sleep(step.timeout)
            return "over"
        actions: dict[str, Callable[[PlannedStep, Node], Awaitable[object]]] = {
            "call": self._call_service,
            "set": self._set,
            "goal": self._send_goal,
            "wait": self._wait,
        }
        return await actions[step.do](step, node)

    async def node(self) -> Node:
        """Return the hidden node, which is started at its first use."""
        if self._node is None:
            self._node = Node(f"_graphflow_{os.getpid()}", start_parameter_services=False, enable_rosout=False)
            self._started = asyncio.ensure_future(core_of(self._node).start(self._context))
        await asyncio.shield(self._started)  # a cancelled step must not cancel the start for the others
        return self._node

    async def _call_service(self, step: PlannedStep, node: Node) -> object:
        return await self.call(await self._type(step), step.target, step.request, step.timeout)

    async def call(self, type_name: str, name: str, fields: dict[str, object], timeout: float) -> Any:
        """Call a service; returns its response.

        Args:
            type_name: As in `std_srvs/srv/Trigger`.
            timeout: Seconds for the server to appear, and again for it to answer.

        Raises:
            CallError: The service is unavailable, failed, or did not answer in time.
            EncodeError: The request does not fit the type.
        """
        node = await self.node()
        service: Any = registry.interface_class(type_name)
        request: Any = from_plain(service.Request, fields)
        client = node.create_client(service, name)
        try:
            await client.expect_ready(timeout)
            return await client.call(request, timeout=timeout)
        finally:
            client.close()

    async def _set(self, step: PlannedStep, node: Node) -> str:
        from graphflow.msgs.rcl_interfaces.msg import Parameter
        from graphflow.runtime.parameters.values import to_message

        def call(service: str, **fields: object) -> Any:
            type_name = f"rcl_interfaces/srv/{service.title().replace('_', '')}"
            return self.call(type_name, f"{step.target}/{service}", fields, step.timeout)

        # YAML's `1` is an integer, which ROS 2 refuses for a double: the declared types decide.
        described = (await call("describe_parameters", names=list(step.request))).descriptors
        wanted = []
        for declared, (name, value) in zip(described, step.request.items(), strict=True):
            if declared.type == _DOUBLE and type(value) is int:
                value = float(value)
            elif declared.type == _DOUBLES and isinstance(value, list):
                value = [float(number) if type(number) is int else number for number in value]
            # An empty list has no type of its own.
            type_ = declared.type if value == [] else type_id(value)
            wanted.append(Parameter(name=name, value=to_message(value, type_)))
        result = (await call("set_parameters_atomically", parameters=wanted)).result
        if not result.successful:
            raise ParameterError(result.reason or f"{step.target} refused it")
        return ", ".join(f"{name} = {value}" for name, value in step.request.items())

    async def _send_goal(self, step: PlannedStep, node: Node) -> object:
        action: Any = registry.interface_class(await self._type(step))
        client = node.create_action_client(action, step.target)
        try:
            await client.expect_ready(step.timeout)
            async with client.send(from_plain(action.Goal, step.request)) as goal:
                return await goal.result(timeout=step.timeout)
        finally:
            client.close()

    async def _wait(self, step: PlannedStep, node: Node) -> str:
        cache = self._context.cache

        def found() -> str:
            if step.target in cache.nodes():
                return "node"
            if step.target in cache.actions():
                return "action"
            kinds = {Kind.PUBLISHER: "topic", Kind.SERVICE: "service"}
            return next((name for kind, name in kinds.items() if cache.endpoints(kind, step.target)), "")

        if not await self._until(lambda: bool(found()), step.timeout):
            known = [*cache.nodes(hidden=False), *cache.topics(), *cache.services()]
            raise ServiceUnavailable(
                f"no node publishes or offers {step.target} after {step.timeout:g} s{did_you_mean(step.target, known)}"
            )
        return f"the {found()} is there"

    async def _type(self, step: PlannedStep) -> str:
        """Return the type of the service or action that a step needs."""
        known = self._types.get(step.name)
        if known:
            return registry.full_name(known)

        def types() -> list[str]:
            if step.do == "goal":
                return self._context.cache.actions().get(step.target, [])
            return [str(server.type) for server in self._context.cache.endpoints(Kind.SERVICE, step.target)]

        if not await self._until(lambda: bool(types()), step.timeout):
            kind = "action" if step.do == "goal" else "service"
            raise ServiceUnavailable(f"no node offers the {kind} {step.target}{self._instead(step)}")
        return types()[0]

    def _instead(self, step: PlannedStep) -> str:
        """Return advice on a step's target that does not exist: its kind, and the key for that."""
        cache = self._context.cache
        actions, (services, hidden) = cache.served_actions(), cache.offered()
        if step.do == "call" and step.target in actions:
            return f"; it is an action: goal: {step.target}"
        if step.do == "goal":
            is_service = step.target in services | hidden
            return f"; it is a service: call: {step.target}" if is_service else cache.instead(step.target, actions)
        return "" if step.target in cache.services() else cache.instead(step.target, services, hidden)

    async def _until(self, condition: Callable[[], bool], timeout: float) -> bool:
        try:
            async with self._context.clock.timeout(timeout):
                await self._context.wait_for(condition)
        except TimeoutError:
            return False
        return True

    async def close(self) -> None:
        if self._node is not None:
            await core_of(self._node).stop()
