"""A diary of a system: who has never ended, who waits for whom, and who took a step when.

It is the truth that reports are held against, and is not read from graphflow's own account of waits.
"""

from __future__ import annotations

import asyncio
import logging
import re
from asyncio import Task
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.wait_graph import WaitGraph, joined
from graphflow.runtime.context import Context
from tests.deadlock.systems import Ask, Step, System, slots


@dataclass(eq=False, slots=True)
class Life:
    """A run of a handler, or a task."""

    id: str
    """As in pictures of waits."""
    holds: set[str]
    """Slots that it has."""
    serves: int
    """The request that it is for; 0 for none."""
    wants: str = ""
    """The slot that it waits to take again."""
    does: Step | None = None
    asks: set[int] = field(default_factory=set)
    """Requests that it waits for."""
    meets: list[int] = field(default_factory=list)
    """Tasks that it waits for, by their starters."""
    moves: list[int] = field(default_factory=list)
    """When it went on, as the diary counts."""
    is_over: bool = False


class Request(NamedTuple):
    ask: Ask
    by: Life
    is_direct: bool
    """It is awaited in the handler's own body and not in a task."""
    replies: str
    """The slot that its answer needs, if any."""


class Report(NamedTuple):
    when: int
    ring: frozenset[str]
    text: str

    @property
    def is_partial(self) -> bool:
        return "(unless something else" in self.text


FORESEEN = re.compile("Mishap|TaskGroup")
"""Errors that are meant to happen."""
STUMBLED = re.compile("LIKELY DEADLOCK|the search for deadlocks|a snapshot of waits that cannot be read")
"""Log records that fail a test, at whatever level."""


def dead(picture: WaitGraph) -> set[str]:
    """Return the deadlocked activities of user code."""
    return {name for name in deadlocked(picture) if not picture.activities[name].is_inner}


class Diary(logging.Handler):
    """The events of one system, in order, each with its time."""

    def __init__(self, system: System) -> None:
        super().__init__(logging.DEBUG)
        self.system = system
        self.contexts: list[Context] = []
        self.breaks = False
        """Whether calls of rings are ended."""
        self.times: list[float] = []
        self.lives: dict[str, Life] = {}
        self.requests: dict[int, Request] = {}
        self.served: dict[int, Life] = {}
        self.tasks: dict[int, Life] = {}
        """By their starters."""
        self.pending = 0
        """Naps, and limits that may end a wait."""
        self.given_up: list[int] = []
        """When a limit, a cancellation or the policy `break` ended something."""
        self.failed: list[int] = []
        """When an error did."""
        self.refused = 0
        """Calls that ended with DeadlockError."""
        self.reports: list[Report] = []
        self.looks: list[Report] = []
        """The deadlocks of the wait graphs that the test has taken."""
        self.behind: list[str] = []
        """Messages that an activity waits behind a reported ring."""
        self.cleared = 0
        """Reports that were taken back."""
        self.stumbled: list[str] = []
        """Log messages that should not have come."""

    def write(self) -> int:
        self.times.append(asyncio.get_running_loop().time())
        return len(self.times) - 1

    def emit(self, record: logging.LogRecord) -> None:
        text = record.getMessage()
        if text.startswith("DEADLOCK"):
            known = {report.ring for report in self.reports}
            told = [(r, report.text) for c in self.contexts for r, report in c.search.reports.items()]
            is_again = text.startswith("DEADLOCK again")
            new = [(ring, whole) for ring, whole in told if whole == text or (is_again and ring not in known)]
            self.reports += [Report(self.write(), ring, whole) for ring, whole in new]
        elif text.startswith("the deadlock of ") and text.endswith(" has cleared"):
            self.cleared += 1
        elif " waits behind the deadlock of " in text:
            self.behind.append(text)
        elif STUMBLED.match(text) or (record.levelno >= logging.ERROR and not FORESEEN.search(text)):
            self.stumbled.append(text)

    def begin(self, context: Context, taken: Iterable[str], serves: int) -> Life:
        """The running task begins to live."""
        me: Any = asyncio.current_task()
        name = f"t{context.search.snapshot.number_of(me)}" if isinstance(me, Task) else me.number
        life = self.lives[f"{context.session.zid}:{name}"] = Life(f"{context.session.zid}:{name}", set(taken), serves)
        if serves:
            self.served[serves] = life
        life.moves.append(self.write())
        return life

    def picture(self) -> WaitGraph:
        """Of all processes, at one moment."""
        return joined([context.search.snapshot.take() for context in self.contexts])

    def look(self) -> None:
        """Note who is dead now; a report of its own, which something that fails may end."""
        now = len(self.times) - 1
        if self.times and (not self.looks or self.looks[-1].when != now):
            self.looks.append(Report(now, frozenset(dead(self.picture())), "(unless something else fails)"))

    # who waits for whom, once nothing moves

    def standing(self) -> list[frozenset[str]]:
        """The rings that are reported and have not cleared."""
        return [ring for context in self.contexts for ring in context.search.reports]

    def stuck(self) -> list[Life]:
        return [life for life in self.lives.values() if not life.is_over]

    def needs(self, server: int) -> list[str]:
        return slots(self.system.servers[server].place, f"server{server}", self.system.servers[server].kind)

    def limit(self, slot: str) -> int:
        return self.system.groups[int(slot[5:])][1] if slot.startswith("group") else 1

    def holders(self, slot: str) -> set[Life]:
        """Those who hold all slots of a group; nobody when one is free."""
        found = {life for life in self.lives.values() if slot in life.holds}
        return found if len(found) >= self.limit(slot) else set()

    def missing(self, life: Life) -> Iterator[str]:
        """The slots without which somebody does not go on."""
        if life.wants:
            yield life.wants
        for number in life.asks:
            request = self.requests[number]
            if number not in self.served:
                yield from self.needs(request.ask.server)
            elif self.served[number].is_over and request.replies:
                yield request.replies

    def edges(self, life: Life) -> set[Life]:
        servers = {self.served[number] for number in life.asks if number in self.served}
        tasks = {self.tasks[number] for number in life.meets}
        return {o for o in servers | tasks if not o.is_over}.union(*map(self.holders, self.missing(life)))

    def before(self, life: Life) -> set[Life]:
        """Who has to go on before somebody does, himself included if he waits for himself."""
        found: set[Life] = set()
        todo = [life]
        while todo:
            new = self.edges(todo.pop()) - found
            found |= new
            todo += new
        return found

    def deadlocks(self) -> list[set[Life]]:
        """Those who wait for each other and for nobody else: the least that has to be reported."""
        reached = {life: self.before(life) for life in self.stuck()}
        assert all(reached.values()), "somebody waits for nothing"
        found = [reach for life, reach in reached.items() if all(life in reached[other] for other in reach)]
        return [reach for i, reach in enumerate(found) if reach not in found[:i]]

    def last_move(self, life: Life) -> int:
        """When it began to wait as it does, or the answers came that wait for a slot."""
        return max(life.moves[-1], *(self.served[i].moves[-1] for i in life.asks if i in self.served), 0)

    def hopeless(self) -> list[int]:
        """Calls whose server's group is full of those who wait, directly or through each other, for them."""
        found = []
        for number, request in self.requests.items():
            server = request.ask.server
            waits = number in request.by.asks and number not in self.served
            if waits and request.is_direct and not self.system.servers[server].is_action:
                [slot] = self.needs(server)
                if self.holders(slot) and self.holders(slot) <= self._chain(request):
                    found.append(number)
        return found

    def _chain(self, request: Request | None) -> set[Life]:
        """Those who await a call directly, and the calls for which they do it; a goal begins a new chain."""
        found: set[Life] = set()
        while request is not None and request.is_direct:
            found.add(request.by)
            request = self.requests.get(request.by.serves)
            if request is not None and self.system.servers[request.ask.server].is_action:
                break
        return found
