"""The wait-for graph: who waits for whom, in one snapshot of a graph.

The snapshot holds *activities* (runs of handlers and tasks under way), the *groups* whose slots they hold, and the
*queues* of handlers. An activity that waits does so for a call, for a slot, for another activity, for something that
only certain handlers set, or for all or any of several such things.
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
    """Wait for the answer to a call, or for the end of a goal."""

    id: str
    name: str
    """The name of the service or action."""
    servers: int = 1
    """How many servers have the request: each may answer it."""


def call_id(gid: bytes, sequence: int) -> str:
    """The name of a call in the snapshots of all processes."""
    return f"{gid.hex()}:{abs(sequence)}"


def goal_id(raw: bytes) -> str:
    """The name of a goal in the snapshots of all processes."""
    return f"goal:{raw.hex()}"


@dataclass(frozen=True, slots=True)
class Slot:
    """Wait for a slot of a group, to return to it."""

    group: str
    ticket: int


@dataclass(frozen=True, slots=True)
class Opening:
    """Wait for somebody to offer a service."""

    service: str


@dataclass(frozen=True, slots=True)
class Join:
    """Wait for the end of another activity."""

    activity: str


@dataclass(frozen=True, slots=True)
class SetBy:
    """Wait for something that, as far as the source code tells, only these handlers and activities bring about."""

    what: str
    """What is waited for, in words: `self.arrived`."""
    queues: tuple[str, ...]
    """The queues of those handlers."""
    activities: tuple[str, ...] = ()
    is_held: bool = False
    """Whether that is a lock or the like, held by those activities."""
    deed: str = "sets"
    """What they do to it: `fills` a queue, `releases` a lock."""
    gives_up: bool = False
    """Whether a deadline ends the wait for good, and not only this attempt."""


@dataclass(frozen=True, slots=True)
class All:
    """Wait for every one of these."""

    of: tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class AnyOf:
    """Wait for any one of these."""

    of: tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class Free:
    """Wait for what the snapshot does not show: time, a thread, the outside world."""


FREE = Free()
Condition = Call | Slot | Opening | Join | SetBy | All | AnyOf | Free


def parts_of(condition: Condition) -> Iterator[Condition]:
    """What a condition is made of; itself, if it is no combination."""
    if isinstance(condition, (All, AnyOf)):
        for inner in condition.of:
            yield from parts_of(inner)
    else:
        yield condition


def calls_of(condition: Condition) -> list[Call]:
    """The calls in a condition."""
    return [part for part in parts_of(condition) if isinstance(part, Call)]


@dataclass(frozen=True, slots=True)
class ActivityView:
    """A run of a handler, or a task."""

    id: str
    label: str
    """Method and kind: `tick`, `service add`."""
    node: str
    holds: tuple[str, ...] = ()
    """The groups whose slots the activity holds."""
    wait: Condition = FREE
    serves: str = ""
    """The call or goal that the activity answers."""
    place: Place = field(default_factory=lambda: Place(""))
    """Where the activity waits."""
    function: str = ""
    age: float = 0.0
    """Seconds that the activity has waited."""
    left: float | None = None
    """Seconds until its call times out; None if never."""
    process: str = ""
    """The id of its process's Zenoh session, in hex."""
    is_inner: bool = False
    """Whether the activity is graphflow's own, not something users wrote."""
    is_async: bool = True
    """Whether `await` is allowed where the activity waits."""
    called: str = ""
    """Where its own method calls what waits, if that is another: `arm.py:12 in tick`."""

    @property
    def handler(self) -> str:
        """The method that runs: `tick` of `timer tick`."""
        return method_of(self.label)

    @property
    def line(self) -> Place:
        """Where the activity waits, with the file's name alone: `arm.py:12`."""
        return Place(PurePath(self.place.file).name, self.place.line)


Sort = Literal["", "callback", "executor", "spinner"]
"""What acts as a group where code is rclpy's: a callback group, an executor's threads, or those that could spin."""


@dataclass(frozen=True, slots=True)
class GroupView:
    """A concurrency group of a node, or what acts as one: a handler's own queue, or `on_start`, which keeps all out."""

    id: str
    name: str
    """Empty for what only acts as a group."""
    node: str
    limit: int | None = 1
    is_declared: bool = True
    """Whether the class or a graph file names the group, not only code that makes handlers at run time."""
    is_threaded: bool = False
    is_start: bool = False
    """Whether this is `on_start`: handlers begin, and services open, when it has returned."""
    sort: Sort = ""
    """Empty for what is graphflow's own."""


@dataclass(frozen=True, slots=True)
class QueueView:
    """What waits to be handled by one handler."""

    id: str
    label: str
    node: str
    needs: tuple[str, ...]
    """The groups whose slots the next run takes."""
    calls: tuple[str, ...] = ()
    """Calls and goals that wait, in order."""
    waiting: int = 0
    """Number of items that wait, of any kind."""
    dropped: int = 0
    process: str = ""
    is_declared: bool = True
    """Whether the handler is known before the node is made, so that a graph file can move it."""
    opens: tuple[str, ...] = ()
    """The services that there will be once the handler may run."""

    @property
    def handler(self) -> str:
        """The method that is run: `add` of `service add`."""
        return method_of(self.label)

    @property
    def has_answers(self) -> bool:
        """Whether its items are the answers to calls."""
        return self.label.startswith("reply ")

    @property
    def work(self) -> str:
        """What its items have done, in words: the method that is run, or what follows an answer."""
        return f"what follows the answer of {self.handler}" if self.has_answers else self.handler


@dataclass(frozen=True, slots=True)
class WaitGraph:
    """Who waits for whom in one process, or in several. No group has the id of an activity."""

    activities: Mapping[str, ActivityView] = field(default_factory=dict)
    groups: Mapping[str, GroupView] = field(default_factory=dict)
    queues: Mapping[str, QueueView] = field(default_factory=dict)
    blocked: Mapping[str, str] = field(default_factory=dict)
    """The activity that blocks the event loop, by process."""
    regroupings: Mapping[str, Regrouping] = field(default_factory=dict)
    """What graph files say of groups, by node."""

    def regrouping(self, node: str) -> Regrouping:
        """What a graph file says of a node's groups."""
        return self.regroupings.get(node, Regrouping())


def joined(pictures: Iterable[WaitGraph]) -> WaitGraph:
    """Several processes as one snapshot."""
    activities: dict[str, ActivityView] = {}
    groups: dict[str, GroupView] = {}
    queues: dict[str, QueueView] = {}
    blocked: dict[str, str] = {}
    regroupings: dict[str, Regrouping] = {}
    for graph in pictures:
        activities.update(graph.activities)
        groups.update(graph.groups)
        queues.update(graph.queues)
        blocked.update(graph.blocked)
        regroupings.update(graph.regroupings)
    return WaitGraph(activities, groups, queues, blocked, regroupings)


def method_of(label: str) -> str:
    """The method in an activity's or a queue's label: `tick` of `timer tick`."""
    return label.rpartition(" ")[2]
