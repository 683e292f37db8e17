"""Messages between a supervisor, its preload process and its workers: JSON lines tagged by `do` or `event`.

The types describe what `json` reads and writes; nothing is converted at run time. Import them for type checking only.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NotRequired, TypeAlias, TypedDict, final

if TYPE_CHECKING:
    from graphflow.interface import DeadlockPolicy

NodeJson: TypeAlias = dict[str, object]
"""A planned node as `PlannedNode.to_json` writes it and `node_from_json` reads it."""

InterfacesJson: TypeAlias = dict[str, dict[str, object]]
"""Interfaces by class path, as `classes.interfaces` returns them."""

# Jobs: everything that a process needs to start.


@final
class WorkerJob(TypedDict):
    """A worker and its nodes."""

    process: str
    nodes: list[NodeJson]
    log: NotRequired[str]
    """The file that its output goes to."""
    file: str
    """The graph file."""
    root: str
    """The folder that classes are imported from."""
    domain: int
    mode: str
    """The kind of its Zenoh session: `peer` or `client`."""
    deadlock: DeadlockPolicy
    call_timeout: float | None
    allow_control: bool
    debug: bool


@final
class ProgramJob(TypedDict):
    """A foreign program."""

    command: list[str]
    signal: str
    """Name of the signal that asks it to end."""


Job: TypeAlias = WorkerJob | ProgramJob

# Orders: requests to a worker that runs.


class LoadOrder(TypedDict):
    do: Literal["load"]
    order: int
    node: NodeJson


class UnloadOrder(TypedDict):
    do: Literal["unload"]
    order: int
    node: str


Order: TypeAlias = LoadOrder | UnloadOrder

# Requests to the preload process.


class ProbeRequest(TypedDict):
    """Import classes and describe their interfaces."""

    do: NotRequired[Literal["probe"]]
    classes: list[str]
    root: str
    slips: NotRequired[bool]
    """Whether to look for slips in their source."""
    parent: NotRequired[int]
    """The process whose end ends the import."""


class LogRequest(TypedDict):
    """Write errors of the preload process to a file from now on."""

    do: Literal["log"]
    path: str


class SpawnRequest(TypedDict):
    """Start a process."""

    do: Literal["spawn"]
    process: str
    job: Job
    log: str
    env: dict[str, str]


class OrderRequest(TypedDict):
    """Pass an order on to a worker."""

    do: Literal["tell"]
    process: str
    order: Order


PreloadRequest: TypeAlias = ProbeRequest | LogRequest | SpawnRequest | OrderRequest

# Events of a process, from the worker or from what started it.


class Spawned(TypedDict):
    event: Literal["spawned"]
    process: str
    pid: int


class Ready(TypedDict):
    """A node is ready."""

    event: Literal["ready"]
    process: str
    node: str


class LifecycleChanged(TypedDict):
    """A lifecycle node has come to rest in a state."""

    event: Literal["lifecycle"]
    process: str
    node: str
    state: str


class DebuggerAwaited(TypedDict):
    event: Literal["debugging"]
    process: str
    port: int


class Beat(TypedDict):
    """The event loop of a worker goes round."""

    event: Literal["beat"]
    process: str


class Obeyed(TypedDict):
    """The answer to an order."""

    event: Literal["obeyed"]
    process: str
    order: int
    node: str
    """Full name of the node, once it is known."""
    number: int
    """The number of a loaded node in its process; otherwise 0."""
    error: str
    """Why the order was not carried out; empty if it was."""


class Joined(TypedDict):
    """A node was loaded by ROS 2's service."""

    event: Literal["joined"]
    process: str
    node: NodeJson
    number: int


class Left(TypedDict):
    """A node was unloaded by ROS 2's service."""

    event: Literal["left"]
    process: str
    node: str


class Failed(TypedDict):
    event: Literal["failed"]
    process: str
    error: str


class LogLost(TypedDict):
    """A worker could not write all of its log."""

    event: Literal["log_lost"]
    process: str
    why: str


class Exited(TypedDict):
    event: Literal["exited"]
    process: str
    pid: NotRequired[int | None]
    """None if no process could be started. Only the preload process gives it."""
    status: int | None
    """As `subprocess` gives it: negative for a signal. None if it is unknown."""


ComponentEvent: TypeAlias = Obeyed | Joined | Left
ProcessEvent: TypeAlias = (
    Spawned | Ready | LifecycleChanged | DebuggerAwaited | Beat | ComponentEvent | Failed | LogLost | Exited
)

# Further answers of the preload process.


class Probed(TypedDict):
    event: Literal["probed"]
    interfaces: InterfacesJson


class Broken(TypedDict):
    """The preload process fails."""

    event: Literal["broken"]
    trace: str


PreloadEvent: TypeAlias = ProcessEvent | Probed | Broken
