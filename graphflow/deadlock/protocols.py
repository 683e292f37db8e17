"""What the search sees of a node, and what it needs around it."""

from __future__ import annotations

import asyncio
from asyncio import AbstractEventLoop
from collections.abc import Callable, Sequence
from collections.abc import Set as AbstractSet
from typing import Any, NamedTuple, Protocol

from graphflow.executor.clock import Clock
from graphflow.executor.groups import Groups
from graphflow.executor.ledger import Ledger
from graphflow.executor.runner import Runner
from graphflow.machines.cache import GraphCache, GraphChange
from graphflow.machines.waits.wait_graph import WaitGraph
from graphflow.transport.base import Session


class Unopened(NamedTuple):
    """What a node runs only once its `on_start` has returned."""

    title: str
    """Kind and handler: `service add`."""
    services: tuple[str, ...] = ()
    """The full names of the services that it offers."""


class Subject(Protocol):
    """A node, as the search sees it."""

    @property
    def full_name(self) -> str:
        """Namespace and name."""

    @property
    def instance(self) -> object:
        """The user's object: its attributes are looked at, and the source of its class is read."""

    @property
    def runners(self) -> Sequence[Runner]:
        """The runners of its handlers."""

    @property
    def starting(self) -> asyncio.Task[Any] | None:
        """The task in which its `on_start` runs, until that returns."""

    @property
    def unopened(self) -> Sequence[Unopened]:
        """What will run once `on_start` has returned."""

    @property
    def tasks(self) -> AbstractSet[asyncio.Task[Any]]:
        """The tasks that run alongside them."""

    @property
    def groups(self) -> Groups:
        """The groups whose slots they take."""

    @property
    def handlers(self) -> AbstractSet[str]:
        """Methods that the class declares as handlers."""

    @property
    def hooks(self) -> AbstractSet[str]:
        """Methods that are called outside any handler: checks of parameters, events, whether a goal is wanted."""

    def statistics(self) -> dict[str, dict[str, Any]]:
        """Numbers since the start, by the name of each handler, endpoint and group."""

    def complaints(self) -> Sequence[str]:
        """What is wrong with it that it knows itself, a sentence for each."""


class Elsewhere(Protocol):
    """Callbacks that run elsewhere than on the loop, in threads of somebody else's."""

    def waits(self) -> WaitGraph:
        """Who waits for whom among them. Called on any thread."""

    def groups(self) -> dict[str, list[dict[str, Any]]]:
        """What they are in, by node, as plain data. Called on any thread."""

    def stalls(self) -> list[str]:
        """Reports of runs among them that keep others waiting for long. Called on any thread."""


class ProcessContext(Protocol):
    """What the nodes of one process share, as far as the search needs it."""

    @property
    def session(self) -> Session: ...

    @property
    def domain(self) -> int: ...

    @property
    def loop(self) -> AbstractEventLoop: ...

    @property
    def clock(self) -> Clock: ...

    @property
    def cache(self) -> GraphCache: ...

    @property
    def ledger(self) -> Ledger: ...

    @property
    def nodes(self) -> Sequence[Subject]: ...

    @property
    def elsewhere(self) -> Sequence[Elsewhere]: ...

    def arrived(self) -> list[tuple[Runner, bytes, int]]:
        """Requests that the loop has not seen yet: the runner each is for, the client's GID, its number."""

    def on_change(self, listener: Callable[[GraphChange], None]) -> Callable[[], None]:
        """Call `listener` for every node or endpoint that comes or goes; returns a function that stops this."""
