"""One reading of a process: the nodes, entities, stacks and runs of a context, as they are at one moment."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from rclpy.impl.deadlock.blocking import blocked
from rclpy.impl.deadlock.groups import executors
from rclpy.impl.deadlock.locks import holds
from rclpy.impl.deadlock.stacks import Stack, stacks
from rclpy.impl.entities import Role, entities_of, goal_of, name_of, node_of_goal, role_of
from rclpy.impl.nodes import nodes_of
from rclpy.impl.spinning import Run

if TYPE_CHECKING:
    from rclpy.impl.deadlock.waiting import Waiting
    from rclpy.node import Node
    from rclpy.timer import Timer


class Reading:
    """The groups, callbacks and threads of a process, with the ids by which reports name them.

    Attributes:
        owners: The node of each entity.
        roles: The role of each entity.
        spun: The executors that threads spin.
        levels: The section of a stack in which each run is.
        runs: The runs that have not ended, on a thread or suspended.
        awaited: The threads for whose end or lock others wait.
    """

    def __init__(self, waiting: Waiting) -> None:
        self._waiting, self.context = waiting, waiting.context
        self.zid, self.now = self.context.session.zid, time.monotonic()
        self.nodes = nodes_of(waiting.life)
        self.owners = {entity: node for node in self.nodes for entity in entities_of(node)}
        self.roles = {entity: role_of(entity) for entity in self.owners}
        self.stacks = list(stacks())
        self.spun = {executor for stack in self.stacks for executor in stack.spins}
        self.levels = {level.run: level for stack in self.stacks for level in stack.levels if level.run is not None}
        mine = [executor for executor in executors() if executor.context.life is waiting.life]
        runs = [run for executor in mine for run in list(executor.spinning.running)]
        self.runs: dict[Run, None] = dict.fromkeys([*runs, *self.levels])
        found = [blocked(level) for level in self.levels.values()]
        self.awaited = {one.thread for one in found}
        locks = [one.lock.lock for one in found if one.lock is not None]
        self.awaited |= {s.thread.ident for s in self.stacks for lock in locks if holds(s.levels[0].frames, lock)}

    def id_of(self, thing: object, prefix: str = "r") -> str:
        """Return an id that no other object of any process ever has."""
        return f"{self.zid}:{prefix}{self.number_of(thing)}"

    def number_of(self, thing: object) -> int:
        """Return a number that no other object of this process ever has."""
        return self._waiting.number_of(thing)

    def tick_of(self, timer: Timer) -> str:
        """Return the id of a timer's tick, for which a rate waits like a call for its answer."""
        return f"tick:{self.id_of(timer, 'q')}"

    def age_of(self, stack: Stack) -> float:
        """Return the seconds for which a thread has been in its innermost user function."""
        return max(0.0, self.now - self._waiting.stands_since(stack.thread.ident or 0))

    def node_of(self, run: Run) -> Node | None:
        """Return the node of a run's callback; for a task, one of its executor's nodes."""
        goal = goal_of(run)
        if goal is not None:
            return node_of_goal(goal)
        owner = getattr(run.called, "__self__", None)
        if run.node is None and any(node is owner for node in self.nodes):
            return owner  # a callback after its client's answer
        return run.node if run.node is not None else next(iter(run.executor.spinning.nodes), None)

    def role_of(self, run: Run) -> Role:
        """Return the role of a run."""
        goal = goal_of(run)
        if goal is not None:
            return Role("action", name_of(run.args[0]) or "execute")
        known = None if run.entity is None else self.roles.get(run.entity)
        if known is None:
            return Role("task", name_of(run.called) or "task")
        return known
