"""The implementation of a lifecycle node: `machines.lifecycle` with a level of resources per state."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Iterable
from contextlib import AsyncExitStack
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar, TypeVarTuple

from graphflow.analysis.user_code import short_place
from graphflow.errors import TransitionFailed, TransitionRefused
from graphflow.executor.runner import Runner
from graphflow.machines.lifecycle import (
    TRANSITIONS,
    LifecycleState,
    Outcome,
    Transition,
    after,
    asked,
    available,
    commands,
    path,
)
from graphflow.msgs import registry
from graphflow.qos import SERVICES, Qos
from graphflow.runtime.callables import code_of
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.mistakes.slow_hooks import when_slow
from graphflow.runtime.node_core import NodeCore
from graphflow.runtime.node_work import end_work, limited
from graphflow.runtime.part import Part

if TYPE_CHECKING:
    from graphflow.msgs.lifecycle_msgs import msg, srv

P = TypeVar("P", bound=Part)
Ts = TypeVarTuple("Ts")

LABEL_SHOWN = 40
"""Longest excerpt of an unknown label in messages, in characters: it may come from any client."""


class _Level:
    """The resources acquired by the transition up to one state, released by the transition down."""

    def __init__(self, below: AsyncExitStack) -> None:
        self.below = below
        """The exit stack of the level below."""
        self.parts: list[Part] = []
        self.tasks: list[asyncio.Task[object]] = []


class ManagedCore(NodeCore):
    """The implementation behind a `LifecycleNode`."""

    state = LifecycleState.UNCONFIGURED
    target: LifecycleState | None = None
    """The state to reach at the start; None to leave transitions to other nodes."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self._levels: list[_Level] = []
        self._muted = False
        self._rests = False
        """Whether handlers are paused."""
        self._event: TopicPublisher[Any] | None = None
        self.on_state: Callable[[LifecycleState], None] = _nothing
        """Called with each primary state that the node reaches."""

    def bind(self, **services: bool) -> None:
        event: Any = registry.interface_class("lifecycle_msgs/msg/TransitionEvent")
        self._event = TopicPublisher(self, event, self.names.resolve("~/transition_event"), Qos())
        self._event.is_inner = True
        self._own_services.add(self._event.name)
        self.add(self._event)
        for name, type_name, answer in (
            ("change_state", "ChangeState", self._change_state),
            ("get_state", "GetState", self._get_state),
            ("get_available_states", "GetAvailableStates", self._get_states),
            ("get_available_transitions", "GetAvailableTransitions", self._get_transitions),
            ("get_transition_graph", "GetAvailableTransitions", self._get_graph),
        ):
            self.serve(name, f"lifecycle_msgs/srv/{type_name}", answer, SERVICES)
        super().bind(**services)

    # levels

    def add(self, part: P, *, late: bool = False) -> P:
        added = super().add(part, late=late)
        if self._levels:
            self._levels[-1].parts.append(part)
        if self._rests and not isinstance(part, TopicPublisher):
            self._hold(part)
        if self._muted and isinstance(part, TopicPublisher):
            part.pause(self._why())
        return added

    def forget(self, part: Part) -> None:
        super().forget(part)
        for level in self._levels:
            if part in level.parts:
                level.parts.remove(part)

    def spawn(self, fn: Callable[[*Ts], Coroutine[object, object, object]], *args: *Ts) -> asyncio.Task[object]:
        task = super().spawn(fn, *args)
        if self._levels:
            tasks = self._levels[-1].tasks
            tasks[:] = [*(t for t in tasks if not t.done()), task]
        return task

    def _enter_level(self) -> None:
        self._levels.append(_Level(self.entered))
        self.entered = AsyncExitStack()

    async def _leave_level(self) -> None:
        """Release the resources of the top level. Raises the errors of their release."""
        level = self._levels[-1]
        try:
            await end_work(self.log, [part.begin_to_stop() for part in level.parts], level.tasks)
            await self.entered.aclose()
        finally:
            for part in reversed(level.parts):
                part.close()
            self._levels.remove(level)
            self.entered = level.below

    # activation

    def _why(self) -> str:
        way = commands(self.full_name, self.state)
        return f"{self.full_name} is {self.state.label}, not active{f'; {way}' if way else ''}"

    def _hold(self, part: Part) -> Runner | None:
        return None if part.is_inner else part.pause(self._why())

    async def _rest(self, tasks: Iterable[asyncio.Task[object]] = ()) -> None:
        """End all runs and some tasks, and start no more."""
        if self._rests:
            return
        self._rests = True
        runners = [self._hold(part) for part in self.parts if not isinstance(part, TopicPublisher)]
        await end_work(self.log, runners, tasks)

    async def _work(self) -> None:
        self._rests = False
        for part in [part for part in self.parts if part.idle_because and not isinstance(part, TopicPublisher)]:
            runner = part.resume()
            if runner is not None and runner not in self.runners:
                self.runners.append(runner)
        await super()._begin()

    def _mute(self, *, muted: bool) -> None:
        self._muted = muted
        for part in self.parts:
            if isinstance(part, TopicPublisher) and not part.is_inner:
                part.pause(self._why()) if muted else part.resume()

    # transitions

    def warn_unused_remaps(self) -> None:
        """Postpone the warning until the node is configured, since `on_configure` may create endpoints."""
        self.refuses_unused = False
        if self.state is LifecycleState.INACTIVE:
            super().warn_unused_remaps()

    async def _begin(self) -> None:
        if self.state is LifecycleState.ACTIVE:  # by `on_start`
            await self._work()
        else:
            self._mute(muted=True)
            await self._rest()
        self.on_state(self.state)
        steps = path(self.state, self.target or LifecycleState.ACTIVE)
        if self.target is None and steps:
            way = "or write lifecycle: active in a graph file"
            self.log.info("%s: %s, %s", self.state.label, commands(self.full_name, self.state), way)
        elif self.target is not None:
            for label in steps:
                await self.trigger(label)

    async def trigger(self, wanted: int | str) -> None:
        """Carry out a transition, given by its label or id.

        Raises:
            TransitionFailed: The transition is not possible from the current state, was refused, or failed.
        """
        transition = asked(self.state, wanted)
        if transition is None:
            ways = ", ".join(t.label for t in available(self.state)) if self.state.is_primary else ""
            later = "nothing; let the method for this transition return first"
            now = f"{self.full_name} is {self.state.label}; from there: {ways or later}"
            raise TransitionFailed(f"cannot {_verb(wanted)}: {now}")
        # In a task of its own: the transition may end the caller, or the caller may stop waiting.
        task = super().spawn(self._make, transition)
        task.set_name(f"{self.full_name}.{transition.goal.hook}")
        failure = await asyncio.shield(task)
        if failure:
            raise TransitionFailed(
                f"{self.full_name} could not {transition.label}: {failure}; it is {self.state.label}"
            )

    async def _make(self, transition: Transition) -> str:
        """Carry out a transition; returns the reason for its failure, "" if it succeeded."""
        start = self.state
        self._arrive(transition)
        try:
            outcome, why = await self._attempt(start)
            self._arrive(after(self.state, outcome))
            if self.state is LifecycleState.ERRORPROCESSING:
                outcome, _ = await self._attempt(start)
                self._arrive(after(self.state, outcome))
                self.log.warning("after the error, the node is %s", self.state.label)
        except asyncio.CancelledError:  # the node is stopping
            self._arrive(after(self.state, Outcome.FAILURE))
            raise
        if transition.label == "configure":
            self.warn_unused_remaps()
        if self.state is LifecycleState.ACTIVE and self.has_started:
            await self._work()
        return why

    async def _attempt(self, start: LifecycleState) -> tuple[Outcome, str]:
        """Run the hook of the current state and move to the resulting level; returns the outcome and its reason."""
        hook = self.state.hook
        if start is LifecycleState.ACTIVE:
            await self._rest(self._levels[-1].tasks)
        if self.state in (LifecycleState.CONFIGURING, LifecycleState.ACTIVATING):
            self._enter_level()
        if self.state is LifecycleState.ACTIVATING:
            self._mute(muted=False)
        outcome, why = await self._run_hook(hook)
        goal = after(self.state, outcome).goal
        if not goal.is_primary:
            return outcome, why
        if goal is not LifecycleState.ACTIVE:
            self._mute(muted=True)
        while len(self._levels) > goal.level:
            try:
                await self._leave_level()
            except Exception as error:  # any error of the user's resources: the levels below are released all the same
                self.report_error(f"exiting context managers, after {hook}", error)
                outcome, why = Outcome.ERROR, f"{type(error).__name__}: {error}"
        return outcome, why

    async def _run_hook(self, hook: str) -> tuple[Outcome, str]:
        slow = when_slow(self, hook)
        try:
            returned = await getattr(self.instance, hook)()
            if returned is not None:
                code = code_of(getattr(self.instance, hook))
                where = f" ({short_place(code.co_filename, code.co_firstlineno)})" if code is not None else ""
                text = f"{hook} returned {returned!r}; a hook succeeds by returning None"
                raise TypeError(f'{text}, and refuses by raise TransitionRefused("why"){where}')
        except TransitionRefused as error:
            self.log.warning("%s refused: %s", hook, error)
            return Outcome.FAILURE, f"{hook} refused: {error}"
        except Exception as error:  # of the user's hook: leads to `on_error`
            self.report_error(hook, error)
            return Outcome.ERROR, f"{hook} failed: {type(error).__name__}: {error}"
        finally:
            slow.cancel()
        return Outcome.SUCCESS, ""

    def _arrive(self, transition: Transition) -> None:
        """Enter a transition's target state and publish it."""
        self.state = transition.goal
        for part in self.parts:
            if part.idle_because:
                part.idle_because = self._why()
        assert self._event is not None
        if self._event.is_wanted:
            self._event.publish(self._transition_event(transition))
        if self.state.is_primary:
            self.on_state(self.state)

    async def _finish(self) -> None:
        if self.has_started:
            if self.state is not LifecycleState.FINALIZED:
                last = asked(self.state, "shutdown")
                assert last is not None
                await limited(self, "on_shutdown", partial(self._make, last))
            while self._levels:
                await limited(self, "exiting context managers", self._leave_level)
        await limited(self, "exiting context managers", self.entered.aclose)

    # services

    async def _change_state(self, request: srv.ChangeState_Request) -> srv.ChangeState_Response:
        from graphflow.msgs.lifecycle_msgs.srv import ChangeState

        try:
            await self.trigger(request.transition.label or request.transition.id)
        except TransitionFailed as error:
            self.log.warning("%s", error)
            return ChangeState.Response(success=False)
        return ChangeState.Response(success=True)

    def _get_state(self, request: object) -> srv.GetState_Response:
        from graphflow.msgs.lifecycle_msgs.srv import GetState

        return GetState.Response(current_state=_state(self.state))

    def _get_states(self, request: object) -> srv.GetAvailableStates_Response:
        from graphflow.msgs.lifecycle_msgs.srv import GetAvailableStates

        return GetAvailableStates.Response(available_states=[_state(state) for state in LifecycleState])

    def _get_transitions(self, request: object) -> srv.GetAvailableTransitions_Response:
        return _described(available(self.state))

    def _get_graph(self, request: object) -> srv.GetAvailableTransitions_Response:
        return _described(list(TRANSITIONS))

    def _transition_event(self, transition: Transition) -> Any:
        from graphflow.msgs.lifecycle_msgs.msg import Transition as TransitionMessage

        assert self._event is not None
        event = self._event.type(
            transition=TransitionMessage(id=transition.id, label=transition.label),
            start_state=_state(transition.start),
            goal_state=_state(transition.goal),
        )
        now = self.clock.now()
        if hasattr(event, "stamp"):  # ROS 2 Lyrical's definition
            event.stamp = now
        else:
            event.timestamp = now.nanoseconds
        return event


def _nothing(state: LifecycleState) -> None:
    """Ignore the state."""


def _state(state: LifecycleState) -> msg.State:
    from graphflow.msgs.lifecycle_msgs.msg import State

    return State(id=int(state), label=state.label)


def _described(transitions: list[Transition]) -> srv.GetAvailableTransitions_Response:
    from graphflow.msgs.lifecycle_msgs.msg import Transition as TransitionMessage
    from graphflow.msgs.lifecycle_msgs.msg import TransitionDescription
    from graphflow.msgs.lifecycle_msgs.srv import GetAvailableTransitions

    return GetAvailableTransitions.Response(
        available_transitions=[
            TransitionDescription(
                transition=TransitionMessage(id=t.id, label=t.label),
                start_state=_state(t.start),
                goal_state=_state(t.goal),
            )
            for t in transitions
        ]
    )


def _verb(wanted: int | str) -> str:
    """Return a transition's label for people, from a label or an id."""
    if isinstance(wanted, str):
        return wanted if wanted in {t.label for t in TRANSITIONS} else repr(wanted[:LABEL_SHOWN])
    return next(
        (f"{t.label} (transition {wanted})" for t in TRANSITIONS if t.id == wanted), f"make transition {wanted}"
    )
