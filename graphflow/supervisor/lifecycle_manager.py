"""The lifecycle manager: brings lifecycle nodes of foreign programs to their planned state, by ROS 2's services."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

from graphflow.errors import CallError, ServiceUnavailable, TransitionFailed
from graphflow.graph.plan import PlannedNode
from graphflow.machines.lifecycle import TRANSITIONS, LifecycleState
from graphflow.machines.process import START_LIMIT
from graphflow.runtime.context import Context
from graphflow.supervisor.steps import StepRunner

if TYPE_CHECKING:
    from graphflow.msgs.lifecycle_msgs.srv import ChangeState, GetState
    from graphflow.supervisor.processes.messages import ProcessEvent

APPEAR_LIMIT = START_LIMIT - 2.0
"""Seconds that a program has until its node offers its services."""
_POLL_LIMIT, _POLL_EVERY = 2.0, 0.1
"""Seconds that a response to `get_state` may take, and between two requests."""
_SERVICES = "lifecycle_msgs/srv"
_PRIMARY = {state for state in LifecycleState if state.is_primary and state}
_IDS = {transition.label: transition.id for transition in TRANSITIONS}


class LifecycleManager:
    """The lifecycle nodes of foreign programs; workers manage their own.

    Args:
        steps: Calls the nodes' services.
        on_event: Takes in events as a worker would report them: `lifecycle`, and `ready` or `failed`.
    """

    def __init__(self, context: Context, steps: StepRunner, on_event: Callable[[ProcessEvent], None]) -> None:
        self._context, self._steps, self._on_event = context, steps, on_event
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._followed: set[str] = set()

    def begin(self, process: str, node: PlannedNode) -> None:
        """Bring up a node whose program has just been started."""
        self.end(process)
        self._tasks[process] = asyncio.create_task(self._bring_up(process, node), name=f"bring up {node.name}")

    def end(self, process: str) -> None:
        """Stop managing a node whose program has ended."""
        if process in self._tasks:
            self._tasks.pop(process).cancel()

    async def close(self) -> None:
        """Stop managing all nodes."""
        tasks = list(self._tasks.values())
        for process in list(self._tasks):
            self.end(process)
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _bring_up(self, process: str, node: PlannedNode) -> None:
        try:
            await self._follow(process, node.name)
            await self._raise_to(LifecycleState[node.lifecycle.upper()], node.name)
        except (CallError, TransitionFailed) as error:
            self._on_event({"event": "failed", "process": process, "error": str(error)})
        else:
            self._on_event({"event": "ready", "process": process, "node": node.name})

    async def _raise_to(self, target: LifecycleState, node: str) -> None:
        """Take the transitions up to a state; a node that already is in it, or above, is left alone.

        Raises:
            TransitionFailed: A transition did not succeed.
            CallError: The node does not answer.
        """
        state = await self._state(node)
        while state.level < target.level:
            label = "configure" if state.level == 0 else "activate"
            request: dict[str, object] = {"transition": {"id": _IDS[label], "label": label}}
            changed: ChangeState.Response = await self._steps.call(
                f"{_SERVICES}/ChangeState", f"{node}/change_state", request, START_LIMIT
            )
            state = await self._state(node)
            if not changed.success:
                raise TransitionFailed(f"{node}: {label} did not succeed, and it is {state.label}; its log may say why")

    async def _state(self, node: str) -> LifecycleState:
        """Poll a node until it is in a primary state; returns that."""
        clock, number = self._context.clock, 0
        try:
            async with clock.timeout(APPEAR_LIMIT):
                while True:
                    # calls fail while the graph cache knows only the services of the previous process
                    with suppress(CallError):
                        answer: GetState.Response = await self._steps.call(
                            f"{_SERVICES}/GetState", f"{node}/get_state", {}, _POLL_LIMIT
                        )
                        number = answer.current_state.id
                    if number in _PRIMARY:
                        break
                    await clock.sleep(_POLL_EVERY)
        except TimeoutError:
            what = "does not come to rest" if number else "offers no get_state, as lifecycle nodes do; is it one?"
            raise ServiceUnavailable(f"{node} {what}") from None
        if number == LifecycleState.FINALIZED:
            raise TransitionFailed(f"{node} is finalized: it can only be started again")
        return LifecycleState(number)

    async def _follow(self, process: str, node: str) -> None:
        """Report every primary state that a node comes to."""
        from graphflow.msgs.lifecycle_msgs.msg import TransitionEvent

        if node in self._followed:
            return
        self._followed.add(node)

        def report(event: TransitionEvent) -> None:
            if event.goal_state.id in _PRIMARY:
                label = LifecycleState(event.goal_state.id).label
                self._on_event({"event": "lifecycle", "process": process, "node": node, "state": label})

        own = await self._steps.node()
        own.create_subscription(TransitionEvent, f"{node}/transition_event", report)
