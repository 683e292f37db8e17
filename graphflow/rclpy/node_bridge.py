"""The graphflow node behind an rclpy node, and the bell that its arrivals ring."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, ClassVar, Protocol, TypeVar

from graphflow.graph import params_file
from graphflow.graph.param_places import place_of
from graphflow.names import Remap, Resolver
from graphflow.qos import SERVICES
from graphflow.rclpy.context_state import LOOP, ContextState
from graphflow.runtime.args import RosArgs
from graphflow.runtime.failures import ErrorBudget
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import NodeCore, core_of
from graphflow.runtime.node_services import TypeDescriptions
from graphflow.runtime.part import Part
from graphflow.transport.inbox import Inbox
from graphflow.wire.liveliness import Entity

P = TypeVar("P", bound=Part)

SEEN_LIMIT = 2.0
"""Seconds within which a node and its endpoints must appear in the process's own graph cache."""


class Waker(Protocol):
    """An executor, as nodes see it."""

    def wake(self) -> None: ...


class NodeBell:
    """Wakes a node's executor; without one, arrivals wait."""

    def __init__(self) -> None:
        self.rung: deque[Inbox] = deque()
        self.pending = False
        self.marked: deque[object] = deque()
        """Entities that have signalled work and have not been attended to."""
        self.ready: dict[Any, None] = {}
        """Entities that may have work."""
        self.executor: Callable[[], Waker | None] = _none

    def ring(self) -> None:
        self.pending = True
        executor = self.executor()
        if executor is not None:
            executor.wake()

    def mark(self, entity: object) -> None:
        """Signal that an entity has work. Callable from any thread."""
        self.marked.append(entity)
        self.ring()

    def wake(self) -> None:
        """Make the executor recheck timers and readiness."""
        self.ring()

    def attend(self) -> None:
        """Move all marked entities to `ready`. For the thread that polls for work."""
        self.pending = False
        rung, marked = self.rung, self.marked
        while rung:
            inbox = rung.popleft()
            inbox.ringing = False  # before it is read, so that what arrives now rings again
            inbox.ready()
        while marked:
            self.ready[marked.popleft()] = None


class Mark:
    """Signals an entity's work to the node's bell, as soon as the entity exists."""

    def __init__(self, bell: NodeBell) -> None:
        self._bell = bell
        self.entity: object = None

    def __call__(self) -> None:
        if self.entity is not None:
            self._bell.ready[self.entity] = None


def _none() -> None:
    """Return no executor."""


class HeldNode(Node):
    """A graphflow node whose endpoints rclpy creates, and whose class is named after the user's."""

    dynamic_names: ClassVar[bool | Sequence[str]] = True
    error_budget: ClassVar[ErrorBudget | None] = None


def overrides_for(args: RosArgs, names: Resolver) -> dict[str, tuple[object, str]]:
    """Return the parameter values that the arguments set for a node, each with its source.

    Raises:
        GraphFileError: A parameter file is wrong.
    """
    found: dict[str, tuple[object, str]] = {}
    for file in args.params_files:
        for name, setting in params_file.params_for(params_file.read(Path(file), file), names.full_name).items():
            found[name] = (setting.value, str(setting.place))
    known = (None, names.name, names.full_name)
    given = ((name, value, source) for node, name, value, source in args.params if node in known)
    return found | {name: (value, place_of(name, value, os.environ) or source) for name, value, source in given}


def open_node(life: ContextState, name: str, namespace: str, remaps: Sequence[Remap], *, rosout: bool) -> HeldNode:
    """Open a node on the network.

    Args:
        rosout: Whether its log is published on /rosout.

    Raises:
        GraphflowError: A name is illegal, or the network cannot be joined.
    """
    return LOOP.wait(_start, life.network(), name, namespace, remaps, rosout)


async def _start(context: Any, name: str, namespace: str, remaps: Sequence[Remap], rosout: bool) -> HeldNode:
    node = HeldNode(
        name,
        namespace=namespace,
        remap=remaps,
        start_parameter_services=False,
        enable_rosout=rosout,
        enable_logger_service=False,
    )
    core = core_of(node)
    await core.start(context)
    zid = context.session.zid
    await _seen(core, lambda: any(e.zid == zid and e.nid == core.id for e in context.cache.owners(core.full_name)))
    return node


async def _seen(core: NodeCore, condition: Callable[[], bool]) -> None:
    async with core.context.clock.timeout(SEEN_LIMIT):
        await core.context.wait_for(condition)


def describe_types(node: HeldNode) -> None:
    """Serve the definitions of a node's types to others. Runs on the loop."""
    core = core_of(node)
    descriptions = TypeDescriptions(lambda: core.endpoints)
    name = "type_description_interfaces/srv/GetTypeDescription"
    core.serve("get_type_description", name, descriptions.get, SERVICES)


def add(node: HeldNode, make: Callable[[NodeCore], P]) -> P:
    """Add the endpoint that `make(core)` creates on the loop to a node, and wait until the graph shows it."""
    made: P = LOOP.wait(_add, core_of(node), make)
    return made


async def _add(core: Any, make: Callable[[NodeCore], P]) -> P:
    part = make(core)
    core.add(part)
    tokens = [e.entity.token for e in part.endpoints if isinstance(e.entity, Entity)]
    await _seen(core, lambda: all(token in core.context.cache for token in tokens))
    return part


def remove(part: Part) -> None:
    """Withdraw an endpoint, unless the context has already left the network."""
    LOOP.wait(_remove, part)


async def _remove(part: Part) -> None:
    host: NodeCore = part.host  # type: ignore[attr-defined]
    tokens = [e.entity.token for e in part.endpoints if isinstance(e.entity, Entity)]
    part.close()
    if host.is_running:
        await _seen(host, lambda: not any(token in host.context.cache for token in tokens))


def close_node(node: HeldNode) -> None:
    """Close a node's endpoints and take it off the network."""
    LOOP.wait(_close, core_of(node))


async def _close(core: NodeCore) -> None:
    if not core.is_running:
        return
    context, zid = core.context, core.context.session.zid
    await core.stop()
    async with context.clock.timeout(SEEN_LIMIT):
        await context.wait_for(lambda: not any(e.zid == zid and e.nid == core.id for e in context.cache))
