"""The wait-for graph of one snapshot: activities, the resources they hold, and the condition each one waits for.

The model is the general AND/OR model of deadlock theory, in which a wait is a boolean formula over other activities:

- *Activities* are the processes of the theory: runs of handlers, and tasks.
- *Groups* are its reusable resources, with `limit` units each, called slots. A run holds its slots until it ends.
- *Queues* are the handlers of a node with the requests that no run has taken yet. A handler that is not running can
  still end a wait, by running; so a wait may lead through a queue to the groups that its next run needs.
- A *condition* is the formula. `All` is AND (`gather`, `TaskGroup`). `AnyOf` is OR (`wait` for the first). The
  leaves are OR nodes, too: a `Call` is answered by any of its servers, a full group is freed by any holder, `SetBy`
  is met by any of its setters.

`FREE` is the leaf that the snapshot cannot see behind (a timer, a socket, a user's thread). It counts as an event that
may happen at any time, which errs on the side of reporting nothing.

Source: Knapp, "Deadlock detection in distributed databases", ACM Computing Surveys 19 (1987), for the models.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import Literal

from graphflow.errors import Place
from graphflow.machines.regrouping import Regrouping


@dataclass(frozen=True, slots=True)
class Call:
    """A wait for the response to a service call, or for the end of a goal."""

    id: str
    name: str
    """The name of the service or action."""
    servers: int = 1
    """Number of servers that have the request, each of which may answer it."""


def call_id(gid: bytes, sequence: int) -> str:
    """Return the id of a call, the same in the snapshots of all processes."""
    # Of an error on a direct line, the sequence number is negative.
    return f"{gid.hex()}:{abs(sequence)}"


def goal_id(raw: bytes) -> str:
    """Return the id of a goal, the same in the snapshots of all processes."""
    return f"goal:{raw.hex()}"


@dataclass(frozen=True, slots=True)
class Slot:
    """A wait for a slot of a group that a run released while it waited, and needs again to go on."""

    group: str
    ticket: int
    """Number of the run, which tells apart the waits of two runs for one group."""


@dataclass(frozen=True, slots=True)
class Opening:
    """A wait for a service to be offered."""

    service: str


@dataclass(frozen=True, slots=True)
class Join:
    """A wait for the end of another activity."""

    activity: str


@dataclass(frozen=True, slots=True)
class SetBy:
    """A wait for a change that, by the source code, only these handlers and activities can make.

    The only condition that rests on the closed-world assumption: see `deadlock.closed_world`.
    """

    what: str
    """The awaited object as the code writes it: `self.arrived`."""
    queues: tuple[str, ...]
    """Queues of the handlers that make the change when they run."""
    activities: tuple[str, ...] = ()
    """Activities under way that may still make it."""
    is_held: bool = False
    """Whether the object is a lock, semaphore or condition that those activities are inside of."""
    verb: str = "sets"
    """Verb for the change: `fills` a queue, `releases` a lock."""
    gives_up: bool = False
    """Whether a deadline ends the wait for good, and not only this attempt."""


@dataclass(frozen=True, slots=True)
class TransformWait:
    """A wait for a transform between two frames, which a handler of any process may send.

    `machines.waits.transform_waits` turns it into a `SetBy` once the waits of all these processes are known.
    """

    what: str
    """The transform: `the transform map -> base_link`."""
    processes: tuple[str, ...]
    """Processes with nodes, by the ids of their sessions."""
    frames: tuple[str, ...] = ()
    """Frames that no transform has named or connected yet."""
    node: str = ""
    """The node that has sent the transform, if the latest is too old."""


@dataclass(frozen=True, slots=True)
class All:
    """A wait for all of several conditions (AND)."""

    of: tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class AnyOf:
    """A wait for any of several conditions (OR)."""

    of: tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class Free:
    """No wait, or one for events that the snapshot does not show: time, a thread, the outside world."""


FREE = Free()
Condition = Call | Slot | Opening | Join | SetBy | TransformWait | All | AnyOf | Free


def parts_of(condition: Condition) -> Iterator[Condition]:
    """Yield the leaves of a condition."""
    if isinstance(condition, (All, AnyOf)):
        for inner in condition.of:
            yield from parts_of(inner)
    else:
        yield condition


def calls_of(condition: Condition) -> list[Call]:
    """Return the calls among the leaves of a condition."""
    return [part for part in parts_of(condition) if isinstance(part, Call)]


@dataclass(frozen=True, slots=True)
class ActivityView:
    """A run of a handler, or a task."""

    id: str
    label: str
    """Kind and method: `timer tick`, `service add`."""
    node: str
    holds: tuple[str, ...] = ()
    """Ids of the groups whose slots the activity holds."""
    wait: Condition = FREE
    serves: str = ""
    """Id of the call or goal that ends when the activity does."""
    place: Place = field(default_factory=lambda: Place(""))
    """Line in the user's code at which the activity waits."""
    function: str = ""
    """Function that contains `place`."""
    age: float = 0.0
    """Seconds that the activity has waited."""
    left: float | None = None
    """Seconds until the wait times out; None for no timeout."""
    process: str = ""
    """Id of its process's Zenoh session, in hex."""
    is_inner: bool = False
    """Whether the activity is graphflow's own rather than a user's."""
    is_async: bool = True
    """Whether `await` is allowed at `place`."""
    called: str = ""
    """Line at which the node's method called the function that waits, if another does: `arm.py:12 in tick`."""

    sends: tuple[str, ...] | None = None
    """Names of frames in its code, if it may send transforms before it ends; None if it sends none."""

    @property
    def handler(self) -> str:
        """Name of the method that runs: `tick` of `timer tick`."""
        return method_of(self.label)

    @property
    def line(self) -> Place:
        """The place without its folder: `arm.py:12`."""
        return Place(PurePath(self.place.file).name, self.place.line)


Sort = Literal["", "callback", "executor", "spinner"]
"""Kinds of resource that act as groups in rclpy code: a callback group, an executor's threads, threads that spin."""


@dataclass(frozen=True, slots=True)
class GroupView:
    """A reusable resource: a concurrency group of a node, or something with the same rules.

    The latter are a handler's own queue, which runs one item at a time, and `on_start`, without whose end no handler
    of the node begins.
    """

    id: str
    name: str
    """Empty for anything that only acts as a group."""
    node: str
    limit: int | None = 1
    """Number of slots; None for no limit."""
    is_declared: bool = True
    """Whether the class or a graph file declares the group, rather than code that creates handlers at run time."""
    is_threaded: bool = False
    """Whether its `def` handlers run in threads."""
    is_start: bool = False
    """Whether this is `on_start`: handlers begin, and services open, when it has returned."""
    sort: Sort = ""
    """Kind of rclpy's resource; empty for graphflow's own."""


@dataclass(frozen=True, slots=True)
class QueueView:
    """A handler, with the items that wait for its next runs."""

    id: str
    label: str
    """Kind and method: `service add`."""
    node: str
    needs: tuple[str, ...]
    """Ids of the groups of which the next run takes a slot each."""
    calls: tuple[str, ...] = ()
    """Ids of the calls and goals that wait, in order."""
    waiting: int = 0
    """Number of items that wait, of any kind."""
    dropped: int = 0
    """Number of items lost since the start."""
    process: str = ""
    is_declared: bool = True
    """Whether the class declares the handler, so that a graph file can move it to another group."""
    opens: tuple[str, ...] = ()
    """Services that open when the handler may run."""
    sends: tuple[str, ...] | None = None
    """Names of frames in the handler's code, if it may send transforms; None if it sends none."""

    @property
    def handler(self) -> str:
        """Name of the method that runs: `add` of `service add`."""
        return method_of(self.label)

    @property
    def has_answers(self) -> bool:
        """Whether its items are responses to calls that the node made."""
        return self.label.startswith("reply ")

    @property
    def work(self) -> str:
        """Phrase for the work that a run does: the method, or the code that follows a response."""
        return f"what follows the answer of {self.handler}" if self.has_answers else self.handler


@dataclass(frozen=True, slots=True)
class WaitGraph:
    """The waits of one process, or of several. Ids of groups and activities are distinct."""

    activities: Mapping[str, ActivityView] = field(default_factory=dict)
    groups: Mapping[str, GroupView] = field(default_factory=dict)
    queues: Mapping[str, QueueView] = field(default_factory=dict)
    blocked: Mapping[str, str] = field(default_factory=dict)
    """By process: the activity that blocks its event loop, on which all others of that process then wait."""
    regroupings: Mapping[str, Regrouping] = field(default_factory=dict)
    """By node: the changes of its groups that graph files make."""

    def regrouping(self, node: str) -> Regrouping:
        """Return the changes of a node's groups that its graph file makes."""
        return self.regroupings.get(node, Regrouping())


def joined(snapshots: Iterable[WaitGraph]) -> WaitGraph:
    """Merge the snapshots of several processes into one."""
    activities: dict[str, ActivityView] = {}
    groups: dict[str, GroupView] = {}
    queues: dict[str, QueueView] = {}
    blocked: dict[str, str] = {}
    regroupings: dict[str, Regrouping] = {}
    for graph in snapshots:
        activities.update(graph.activities)
        groups.update(graph.groups)
        queues.update(graph.queues)
        blocked.update(graph.blocked)
        regroupings.update(graph.regroupings)
    return WaitGraph(activities, groups, queues, blocked, regroupings)


def method_of(label: str) -> str:
    """Return the method in the label of an activity or queue: `tick` of `timer tick`."""
    return label.rpartition(" ")[2]
