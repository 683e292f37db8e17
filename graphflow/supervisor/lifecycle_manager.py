"""Lifecycle nodes in programs: brought to the state that the graph wants, by ROS 2's services, and followed."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from graphflow.errors import CallError, ServiceUnavailable, TransitionFailed
from graphflow.graph.plan import PlannedNode
from graphflow.machines.lifecycle import TRANSITIONS, LifecycleState
from graphflow.machines.process import START_LIMIT
from graphflow.runtime.context import Context
from graphflow.supervisor.steps import StepRunner

APPEAR_LIMIT = START_LIMIT - 2.0
"""Seconds that a program has until its node offers its services."""
_ASK_LIMIT, _ASK_EVERY = 2.0, 0.1
"""Seconds that an answer about a state may take, and between two questions."""
_SERVICES = "lifecycle_msgs/srv"
_PRIMARY = {state for state in LifecycleState if state.is_primary and state}
_IDS = {transition.label: transition.id for transition in TRANSITIONS}


class Lives:
    """Brings the lifecycle nodes of programs up, as workers do with theirs.

    Args:
        steps: What calls their services.
        heard: Takes in what becomes of them, as events of a worker: `lifecycle`, and `ready` or `failed`.
    """

    def __init__(self, context: Context, steps: StepRunner, heard: Callable[[dict[str, Any]], None]) -> None:
        self._context, self._steps, self._heard = context, steps, heard
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._followed: set[str] = set()

    def begin(self, process: str, node: PlannedNode) -> None:
        """Bring a node up whose program has just been started."""
        self.end(process)
        self._tasks[process] = asyncio.create_task(self._bring_up(process, node), name=f"bring up {node.name}")

    def end(self, process: str) -> None:
        """Leave a node alone, whose program has ended."""
        if process in self._tasks:
            self._tasks.pop(process).cancel()

    async def close(self) -> None:
        """Leave all alone."""
        tasks = list(self._tasks.values())
        for process in list(self._tasks):
            self.end(process)
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _bring_up(self, process: str, node: PlannedNode) -> None:
        try:
            await self._follow(process, node.name)
            await self._raise_to(LifecycleState[node.lifecycle.upper()], node.name)
        except (CallError, TransitionFailed) as error:
            self._heard({"event": "failed", "process": process, "error": str(error)})
        else:
            self._heard({"event": "ready", "process": process, "node": node.name})

    async def _raise_to(self, target: LifecycleState, node: str) -> None:
        """Take the steps up that lead to a state; a node that is there by itself is left alone.

        Raises:
            TransitionFailed: One did not succeed.
            CallError: The node does not answer.
        """
        state = await self._state(node)
        while state.level < target.level:
            word = "configure" if state.level == 0 else "activate"
            request = {"transition": {"id": _IDS[word], "label": word}}
            changed = await self._steps.call(f"{_SERVICES}/ChangeState", f"{node}/change_state", request, START_LIMIT)
            state = await self._state(node)
            if not changed.success:
                raise TransitionFailed(f"{node}: {word} did not succeed, and it is {state.label}; its log may say why")

    async def _state(self, node: str) -> LifecycleState:
        """The state in which a node rests, once it answers that it does."""
        clock, number = self._context.clock, 0
        try:
            async with clock.timeout(APPEAR_LIMIT):
                while True:
                    # nobody answers while only the services of the process before this one are known
                    with suppress(CallError):
                        answer = await self._steps.call(f"{_SERVICES}/GetState", f"{node}/get_state", {}, _ASK_LIMIT)
                        number = answer.current_state.id
                    if number in _PRIMARY:
                        break
                    await clock.sleep(_ASK_EVERY)
        except TimeoutError:
            what = "does not come to rest" if number else "offers no get_state, as lifecycle nodes do; is it one?"
            raise ServiceUnavailable(f"{node} {what}") from None
        if number == LifecycleState.FINALIZED:
            raise TransitionFailed(f"{node} is finalized: it can only be started again")
        return LifecycleState(number)

    async def _follow(self, process: str, node: str) -> None:
        """Hear of every state in which a node comes to rest."""
        from graphflow.msgs.lifecycle_msgs.msg import TransitionEvent

        if node in self._followed:
            return
        self._followed.add(node)

        def tell(event: TransitionEvent) -> None:
            if event.goal_state.id in _PRIMARY:
                label = LifecycleState(event.goal_state.id).label
                self._heard({"event": "lifecycle", "process": process, "node": node, "state": label})

        own = await self._steps.node()
        own.create_subscription(TransitionEvent, f"{node}/transition_event", tell)
