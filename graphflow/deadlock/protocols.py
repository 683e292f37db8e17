"""The interfaces between the search and the runtime: protocols, so that the search imports neither nodes nor rclpy."""

from __future__ import annotations

import asyncio
from asyncio import AbstractEventLoop
from collections.abc import Callable, Mapping, Sequence
from collections.abc import Set as AbstractSet
from typing import NamedTuple, Protocol

from graphflow.executor.clock import Clock
from graphflow.executor.groups import Groups
from graphflow.executor.ledger import Ledger
from graphflow.executor.runner import Runner
from graphflow.machines.cache import GraphCache, GraphChange
from graphflow.machines.waits.wait_graph import WaitGraph
from graphflow.transport.base import Session


class Unopened(NamedTuple):
    """A handler that a node will run only once its `on_start` has returned."""

    title: str
    """Kind and handler: `service add`."""
    services: tuple[str, ...] = ()
    """Full names of the services that it will offer."""


class Subject(Protocol):
    """A node, as the search needs it."""

    @property
    def full_name(self) -> str:
        """Namespace and name."""

    @property
    def instance(self) -> object:
        """User's object, whose attributes and source the search reads."""

    @property
    def runners(self) -> Sequence[Runner]:
        """Runners of its handlers."""

    @property
    def starting(self) -> asyncio.Task[object] | None:
        """Task that runs its `on_start`; None once that has returned."""

    @property
    def unopened(self) -> Sequence[Unopened]:
        """Handlers that will run once `on_start` has returned."""

    @property
    def tasks(self) -> AbstractSet[asyncio.Task[object]]:
        """Tasks that run alongside the handlers."""

    @property
    def groups(self) -> Groups:
        """Groups whose slots the handlers take."""

    @property
    def handlers(self) -> AbstractSet[str]:
        """Methods that the class declares as handlers."""

    @property
    def hooks(self) -> AbstractSet[str]:
        """Methods called outside any handler: parameter checks, event callbacks, decisions about goals."""

    @property
    def transforms(self) -> AbstractSet[str]:
        """Attributes with transforms, of which the node may send some; "" for one in no attribute."""

    def statistics(self) -> Mapping[str, Mapping[str, object]]:
        """Return counts since the start, by the name of each handler, endpoint and group."""

    def complaints(self) -> Sequence[str]:
        """Return the problems that the node has detected in itself, a sentence for each."""


class Elsewhere(Protocol):
    """Callbacks that run in threads of another executor than the loop: rclpy's."""

    def waits(self) -> WaitGraph:
        """Return the waits of these callbacks. Called on any thread."""

    def groups(self) -> Mapping[str, Sequence[Mapping[str, object]]]:
        """Return the groups of these callbacks as plain data, by node. Called on any thread."""

    def stalls(self) -> list[str]:
        """Return the reports of runs that keep others waiting for long. Called on any thread."""


class ProcessContext(Protocol):
    """The state that the nodes of one process share, as the search needs it."""

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
        """Return the requests that have arrived but not reached the loop: runner, the client's GID, sequence number."""

    def on_change(self, listener: Callable[[GraphChange], None]) -> Callable[[], None]:
        """Call `listener` for every node or endpoint that comes or goes; return a function that stops this."""
