"""A node and a process with no more than the search's protocols name, for tests that set the scene by hand."""

from __future__ import annotations

import asyncio
from asyncio import AbstractEventLoop
from collections import deque
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

from graphflow.deadlock.protocols import Elsewhere, Unopened
from graphflow.executor.groups import Groups, HandlerGroup
from graphflow.executor.ledger import Ledger
from graphflow.executor.runner import Runner, RunnerKind, RunnerSpec
from graphflow.machines.cache import GraphCache, GraphChange
from graphflow.machines.regrouping import Regrouping
from graphflow.testing.clock import ManualClock, settle
from graphflow.transport.memory import MemorySession, Network


@dataclass
class Actor:
    """A node."""

    full_name: str = "/robot"
    instance: object = field(default_factory=SimpleNamespace)
    runners: list[Runner] = field(default_factory=list)
    starting: asyncio.Task[Any] | None = None
    unopened: list[Unopened] = field(default_factory=list)
    tasks: set[asyncio.Task[Any]] = field(default_factory=set)
    groups: Groups = field(default_factory=lambda: Groups({}, None, Regrouping()))
    handlers: set[str] = field(default_factory=set)
    hooks: set[str] = field(default_factory=set)
    transforms: set[str] = field(default_factory=set)

    def statistics(self) -> dict[str, dict[str, Any]]:
        return {}

    def complaints(self) -> list[str]:
        return []


class Stage:
    """A process; made inside of a running loop."""

    def __init__(self) -> None:
        self.loop: AbstractEventLoop = asyncio.get_running_loop()
        self.session: MemorySession = Network().session(self.loop)
        self.domain = 0
        self.clock = ManualClock()
        self.cache = GraphCache()
        self.ledger = Ledger(self.loop)
        self.actors: list[Actor] = []
        self.requests: list[tuple[Runner, bytes, int]] = []

    elsewhere: Sequence[Elsewhere] = ()

    @property
    def nodes(self) -> Sequence[Actor]:
        return self.actors

    def arrived(self) -> list[tuple[Runner, bytes, int]]:
        return self.requests

    def on_change(self, listener: Callable[[GraphChange], None]) -> Callable[[], None]:
        return lambda: None

    def actor(self, instance: object = None, name: str = "/robot") -> Actor:
        """A node of this process."""
        made = Actor(name) if instance is None else Actor(name, instance)
        self.actors.append(made)
        return made

    def handler(
        self,
        actor: Actor,
        name: str,
        body: Callable[[Any], Awaitable[Any] | None] = lambda _: None,
        group: HandlerGroup | None = None,
        *,
        kind: RunnerKind = "subscription",
        is_serial: bool | None = None,
    ) -> Runner:
        """A handler of a node; `wake` it when its queue has been filled."""
        spec = RunnerSpec(name, body, lambda *_: None, actor.full_name, kind, is_serial=is_serial)
        made = Runner(self.ledger, spec, deque(), group)
        actor.runners.append(made)
        actor.handlers.add(name)
        return made


async def begin(runner: Runner, *items: Any) -> None:
    """Have items arrive, and let their runs go as far as they can."""
    runner.items.extend(items)
    asyncio.get_running_loop().call_soon(runner.wake)
    await settle()
