"""Concurrency groups at run time: the groups of a node, and the slots that its handlers' runs occupy."""

from __future__ import annotations

import asyncio
from asyncio import AbstractEventLoop, CancelledError, Future
from collections.abc import AsyncGenerator, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any, Protocol

from graphflow.errors import DeclarationError
from graphflow.interface import NO_GROUP, GroupChange, WhenFull
from graphflow.machines.group import GroupState
from graphflow.machines.regrouping import Regrouping
from graphflow.names import did_you_mean

GROUPS_BOUND = 100
"""Most groups of a node that moving a handler may create."""


class DeclaredGroup(Protocol):
    """A group's declaration in a class."""

    limit: int | None
    when_full: WhenFull
    thread: bool
    name: str


class Member(Protocol):
    """A waiter in a group's queue."""

    def granted(self, group: HandlerGroup) -> None:
        """Accept a slot of `group`, which the member occupies from now on."""

    def yields(self) -> None:
        """Drop queued work: newer work has arrived, in a group that keeps only the newest."""

    def wake(self) -> None:
        """Start the runs that the group allows by now; a member with all its slots has no ticket for more."""


class HandlerGroup(GroupState[Member]):
    """A group of one node. On the node, the class's `Group` declaration reads as this."""

    __slots__ = ("is_threaded",)

    def __init__(
        self, limit: int | None = 1, name: str = "", when_full: Any = "wait", *, is_threaded: bool = False
    ) -> None:
        super().__init__(limit, name, when_full)
        self.is_threaded = is_threaded
        """Whether `def` handlers run in threads."""

    def give_back(self, loop: AbstractEventLoop) -> None:
        """Release a slot at the end of a run: it goes to the member that has waited longest."""
        successor = self.release()
        if successor is not None:
            # Not directly, or the successor's run would begin on the stack of the one that ends.
            loop.call_soon(successor.granted, self)

    def set_limit(self, limit: int | None, loop: AbstractEventLoop) -> None:
        """Change the number of runs allowed at a time; runs in progress continue."""
        self.limit = limit
        while (successor := self.grant()) is not None:
            loop.call_soon(successor.granted, self)
        for member in self.members:
            loop.call_soon(member.wake)

    @asynccontextmanager
    async def released(self) -> AsyncGenerator[None, None]:
        """Release the running handler's slot for the length of the block, then queue for it again at the tail.

            async with self.motion.released():
                await self.planner.call(request)      # other handlers of the group may run

        State that the group protects may have changed when the block ends. A handler that is cancelled in the block
        also waits for its slot before it proceeds to its cleanup, as `asyncio.Condition.wait` does.

        Raises:
            RuntimeError: The caller is not a handler of this group, or is a task that a handler has started.
        """
        run: Any = asyncio.current_task()
        if getattr(run, "group", None) is not self:
            raise RuntimeError(
                f"group {self.name!r} cannot be released here: only a handler that runs in it can do that, in its own "
                "body, not in a task that it has started"
            )
        loop = asyncio.get_running_loop()
        run.group = None
        self.give_back(loop)
        loop.call_soon(run.runner.wake)  # its own handler may also run in the meantime
        try:
            yield
        finally:
            await self._take_again(run, loop)

    async def _take_again(self, run: Any, loop: AbstractEventLoop) -> None:
        returning = _Return(loop)
        cancelled: CancelledError | None = None
        if not self.admit(returning):
            run.returning_to = self
            run.runner.stalled()
            while not returning.slot.done():
                try:
                    await asyncio.shield(returning.slot)
                except CancelledError as error:
                    cancelled = error
            run.returning_to = None
        run.group = self
        if cancelled is not None:
            raise cancelled

    def statistics(self) -> dict[str, Any]:
        """Return the limit, slots taken, waiting members, and the runs started and failed since the start."""
        members: list[Any] = self.members
        return {
            "limit": self.limit,
            "running": self.running,
            "waiting": len(self.waiting),
            "runs": sum(m.runs for m in members),
            "errors": sum(m.errors for m in members),
        }


class _Return:
    """A run that waits to return to its group."""

    def __init__(self, loop: AbstractEventLoop) -> None:
        self.slot: Future[None] = loop.create_future()

    def granted(self, group: HandlerGroup) -> None:
        self.slot.set_result(None)

    def yields(self) -> None:
        """Do nothing: a run in progress is not queued work."""

    def wake(self) -> None:
        """Do nothing: a run in progress has nothing to start."""


@dataclass(frozen=True)
class Placement:
    """A handler's group, and whether it runs in threads."""

    group: HandlerGroup | None
    is_threaded: bool = False


class Groups:
    """The groups of one node, and the assignment of handlers to them.

    Args:
        declared: The groups of the class, by name.
        default: The class's `default_group`.
        regrouping: The graph file's changes.
    """

    def __init__(
        self, declared: Mapping[str, DeclaredGroup], default: DeclaredGroup | None, regrouping: Regrouping
    ) -> None:
        self.regrouping = regrouping
        """The changes in a graph file that would produce the current groups."""
        self.by_name: dict[str, HandlerGroup] = {}
        self._of: dict[DeclaredGroup, HandlerGroup] = {}
        self._default = default
        self._chosen: dict[str, str] = {}
        """Group names that the graph file assigns, by handler."""
        self._placed: list[str] = []
        self._unnamed = 0
        self.known = {*declared, *regrouping.groups}
        """Group names that a graph file can use."""
        for name, group in declared.items():
            self._of[group] = self.by_name.setdefault(name, _made(group, name))
        for name, change in regrouping.groups.items():
            self._change(name, change)

    def _change(self, name: str, change: GroupChange) -> None:
        if name != NO_GROUP:
            group = self.by_name.setdefault(name, HandlerGroup(name=name))
            if change.sets_limit:
                group.limit = change.limit
            if change.when_full is not None:
                group.when_full = change.when_full
            if change.thread is not None:
                group.is_threaded = change.thread
        for handler in change.handlers:
            if handler in self._chosen:
                raise DeclarationError(
                    f"{handler} is put in two groups, {self._chosen[handler]!r} and {name!r}; it can be in only one"
                )
            self._chosen[handler] = name

    def place(self, handler: str, declared: DeclaredGroup | HandlerGroup | None) -> Placement:
        """Return a handler's placement: from the graph file, else as declared, else in the default group."""
        self._placed.append(handler)
        if handler in self._chosen:
            group = self.by_name.get(self._chosen[handler])
        else:
            wanted = declared if declared is not None else self._default
            group = None if wanted is None else self.at_work(wanted)
        return Placement(group, group is not None and group.is_threaded)

    def at_work(self, group: DeclaredGroup | HandlerGroup) -> HandlerGroup:
        """Return the node's group for a declaration; `self.motion` already is one."""
        if isinstance(group, HandlerGroup):
            return group
        if group not in self._of:
            name = group.name
            if not name or name in self.by_name:
                self._unnamed += 1
                name = f"{group.name or 'group'}_{self._unnamed}"
            self._of[group] = self.by_name[name] = _made(group, name)
        return self._of[group]

    def named(self, name: str) -> HandlerGroup | None:
        """Return the group of that name, created if missing; None for the name that means no group.

        Raises:
            DeclarationError: The name is not legal for a group.
        """
        if name == NO_GROUP:
            return None
        if not name.isidentifier():
            raise DeclarationError(f"{name!r} is not a group name; use letters, digits and _")
        if name not in self.by_name and len(self.by_name) >= GROUPS_BOUND:
            raise DeclarationError(f"this node has {GROUPS_BOUND} groups; no more are made")
        return self.by_name.setdefault(name, HandlerGroup(name=name))

    def note_move(self, handler: str, group: str) -> None:
        """Note that a handler has moved to another group."""
        self.regrouping = self.regrouping.moved([handler], group)

    def note_limit(self, group: str, limit: int | None) -> None:
        """Note a group's new limit."""
        self.regrouping = self.regrouping.limited(group, limit)

    def refuse_strays(self) -> None:
        """Raise DeclarationError if the graph file places a handler that the node does not have."""
        for handler, group in self._chosen.items():
            if handler not in self._placed:
                near = did_you_mean(handler, self._placed)
                raise DeclarationError(f"group {group!r} names {handler!r}, which is not a handler of this node{near}")


def _made(group: DeclaredGroup, name: str) -> HandlerGroup:
    return HandlerGroup(group.limit, name, group.when_full, is_threaded=group.thread)
