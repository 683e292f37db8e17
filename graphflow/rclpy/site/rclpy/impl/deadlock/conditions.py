"""The conditions for which the threads and callbacks of one reading wait."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from graphflow.deadlock.closed_world.object_waits import setters
from graphflow.deadlock.closed_world.wakers import Setters
from graphflow.errors import ClosedError
from graphflow.machines.waits.explain import offer
from graphflow.machines.waits.wait_graph import FREE, Call, Condition, Join, SetBy
from graphflow.wire.liveliness import Kind
from rclpy.action.client import ActionClient
from rclpy.client import Client
from rclpy.impl.deadlock.blocking import blocked, is_private, limit_of
from rclpy.impl.deadlock.buffers import BufferWait
from rclpy.impl.deadlock.future_setters import may_be_ended, programs_files
from rclpy.impl.deadlock.groups import threads_of
from rclpy.impl.deadlock.later_servers import opening_of, tries_forever
from rclpy.impl.deadlock.locks import Entering, only_holder
from rclpy.impl.deadlock.stacks import Level
from rclpy.impl.deadlock.subjects import subject_of
from rclpy.impl.entities import after_answers, callback_of, method_of, name_of
from rclpy.impl.nodes import internals_of
from rclpy.impl.spinning import Run

if TYPE_CHECKING:
    from graphflow.analysis.user_code import Pause
    from graphflow.deadlock.protocols import Subject
    from graphflow.runtime.endpoints.threaded import ThreadedClient
    from rclpy.impl.deadlock.reading import Reading
    from rclpy.impl.entities import Role
    from rclpy.impl.spinning import Entity
    from rclpy.node import Node
    from rclpy.task import Future


class Wait(NamedTuple):
    """The condition for which code waits, and for how long at most."""

    condition: Condition = FREE
    limit: float | None = None
    """The time limit in seconds, from the beginning of the wait."""
    pause: Pause | None = None
    """The point of the event loop at which the code is suspended."""
    client_node: Node | None = None
    """The node whose client waits for the answer that is needed."""


class Conditions:
    """The conditions for which the code of one reading waits."""

    def __init__(self, reading: Reading) -> None:
        self._reading = reading

    def of_level(self, level: Level, node: Node | None, run: Run | None) -> Wait:
        """Return the wait of a thread's code.

        Args:
            level: The section of the thread's stack.
            node: The node to which the code belongs.
            run: The run that executes it; None for a thread's own code.
        """
        found = blocked(level)
        if found.future is not None:
            return self.of_future(found.future, level, node, run)._replace(limit=found.timeout)
        if found.timer is not None:
            turn = self._closed_world(level, None, node, run)  # a loop that polls at that rate
            executor = None if run is None else run.executor
            is_alone = executor is None or threads_of(executor) == 1  # then no thread is left to run the tick
            tick = Call(self._reading.tick_of(found.timer), "rate")
            return turn._replace(condition=tick) if turn.condition == FREE or is_alone else turn
        if node is None or (level.waiting is not None and run is None):
            return Wait()
        if found.thread is not None:
            joined = next((stack for stack in self._reading.stacks if stack.thread.ident == found.thread), None)
            return Wait(FREE if joined is None else Join(self._reading.id_of(joined.thread, "t")), found.timeout)
        if found.lock is not None:
            return Wait(self._of_lock(found.lock, level, run))
        if found.buffer is not None:
            return Wait(self._of_buffer(found.buffer), found.timeout)
        if found.service:
            limit = None if level.innermost is None or tries_forever(level.innermost) else found.timeout
            return Wait(self._of_opening(found.service, level, node, run, gives_up=limit is not None), limit)
        return self._closed_world(level, None, node, run)._replace(limit=limit_of(level))

    def of_future(self, future: Future, level: Level, node: Node | None, run: Run | None) -> Wait:
        """Return the wait for a future: for a task, for an answer, or for code that sets it. Arguments as above."""
        if future.done() or future.cancelled():
            return Wait()
        if isinstance(future, Run):
            return Wait(Join(self._reading.id_of(future)) if future in self._reading.runs else FREE)
        for entity, owner in self._reading.owners.items():
            if isinstance(entity, Client):
                sequence = next((n for n, f in list(entity.pending_requests.items()) if f is future), None)
                if sequence is not None:
                    return Wait(self._of_call(entity.endpoint, sequence, future, level), client_node=owner)
            elif isinstance(entity, ActionClient):
                found = next((key for key, (f, _) in list(internals_of(entity).waiting.items()) if f is future), None)
                if found is not None:
                    return Wait(self._of_call(*found, future, level), client_node=owner)
        return self._closed_world(level, future, node, run)

    def _of_call(self, endpoint: ThreadedClient, sequence: int, future: Future, level: Level) -> Condition:
        if not is_private(level) and may_be_ended(future, self._reading.nodes, programs_files()):
            return FREE
        try:
            return Call(endpoint.call_id(sequence), endpoint.name, max(1, self._servers[endpoint.name]))
        except ClosedError:
            return FREE

    @cached_property
    def _servers(self) -> Counter[str]:
        """Return the number of servers by service."""
        return Counter(entity.name for entity in list(self._reading.context.cache) if entity.kind is Kind.SERVICE)

    def _of_lock(self, entering: Entering, level: Level, run: Run | None) -> Condition:
        """Return the wait for a lock that others hold."""
        others = [
            (self._reading.id_of(other), there.frames)
            for other, there in self._reading.levels.items()
            if other is not run
        ]
        others += [
            (self._reading.id_of(s.thread, "t"), s.levels[0].frames)
            for s in self._reading.stacks
            if s.levels[0] is not level
        ]
        if run is not None:
            others.append((self._reading.id_of(run), level.frames[:-1]))  # it may hold the lock itself
        holder = only_holder(entering, level.frames, others)
        return FREE if holder is None else SetBy(entering.text, (), (holder,), True, "releases")

    def _of_buffer(self, wait: BufferWait) -> Condition:
        """Return the wait for a buffer that only blocked listeners would fill."""
        fillers = set(filter(wait.is_filled_by, self._reading.owners))
        if not fillers or wait.may_be_filled_by(programs_files()):
            return FREE
        queues, active = (
            (self._reading.id_of(e, "q") for e in fillers),
            (self._reading.id_of(r) for r in self._reading.runs if r.entity in fillers),
        )
        return SetBy(wait.what, tuple(sorted(queues)), tuple(sorted(active)), verb="hears", gives_up=True)

    def _of_opening(self, service: str, level: Level, node: Node, run: Run | None, *, gives_up: bool) -> Condition:
        """Return the wait for a server that, according to the source, only blocked code creates."""
        (own, tasks, subject), others = self._world(node), [other for other in self._reading.nodes if other is not node]
        found = None if self._servers[service] else opening_of(service, level.frames, subject, others, programs_files())
        if found is None or (found.handlers and any(type(other) is type(node) for other in others)):
            return FREE
        setters_ = Setters(offer(service), found.handlers, verb="offers", gives_up=gives_up)
        condition = self._set_by(setters_, own, tasks, node, run)
        if not found.is_own:
            return condition
        stack = next((stack for stack in self._reading.stacks if level in stack.levels), None)
        mine = (
            self._reading.id_of(run)
            if run is not None
            else self._reading.id_of(stack.thread, "t")
            if stack is not None
            else ""
        )
        return replace(condition, activities=(*condition.activities, mine))

    def _world(self, node: Node) -> tuple[list[tuple[Entity, str]], list[Run], Subject]:
        """Return a node's callbacks by entity, the tasks that run its methods, and the node as a subject."""
        own = [
            (entity, _handler(entity, role, node))
            for entity, role in self._reading.roles.items()
            if self._reading.owners[entity] is node
        ]
        own += [(entity, name) for entity in self._reading.owners for name in after_answers(entity, node)]
        tasks = [task for task in self._reading.runs if getattr(task.called, "__self__", None) is node]
        return (
            own,
            tasks,
            subject_of(node, [*(handler for _, handler in own), *(name_of(task.called) for task in tasks)]),
        )

    def _closed_world(self, level: Level, future: Future | None, node: Node | None, run: Run | None) -> Wait:
        """Return the wait for something that, according to the source, only the node's callbacks bring about."""
        if node is None:
            return Wait()
        own, tasks, subject = self._world(node)
        found = setters(level.frames, future, subject)
        others = [subject_of(other) for other in self._reading.nodes if other is not node]
        is_known = found is not None and found.handlers and found.lock is None and not found.parts
        if found is None or not is_known or found.is_shared(subject, others):
            return Wait()
        return Wait(self._set_by(found, own, tasks, node, run), pause=found.pause)

    def _set_by(
        self, found: Setters, own: list[tuple[Entity, str]], tasks: list[Run], node: Node | None, run: Run | None
    ) -> SetBy:
        queues = {self._reading.id_of(entity, "q") for entity, handler in own if handler in found.handlers}
        others_runs = [r for r in self._reading.runs if r is not run and (r.node is node or r in tasks)]
        active = sorted(
            self._reading.id_of(r)
            for r in others_runs
            if _handler(r.entity, self._reading.role_of(r), node) in found.handlers
        )
        return SetBy(found.what, tuple(sorted(queues)), tuple(active), verb=found.verb, gives_up=found.gives_up)


def _handler(entity: Entity | None, role: Role, node: Node | None) -> str:
    """Return the method that an entity calls, as the source analysis names it; else the name in its role."""
    return (method_of(callback_of(entity), node) if entity is not None else "") or role.handler
