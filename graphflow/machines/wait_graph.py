"""Who waits for whom, as one picture of a graph.

The picture holds *activities* (runs of handlers and tasks under way), the *groups* whose slots they hold, and the
*queues* of handlers. An activity that waits does so for a call, for a slot, for another activity, for something that
only certain handlers set, or for all or any of several such things.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from graphflow.errors import Place


@dataclass(frozen=True, slots=True)
class Call:
    """Wait for the answer to a call, or for the end of a goal."""

    id: str
    name: str
    """Of the service or action."""


def call_id(gid: bytes, sequence: int) -> str:
    """How pictures of all processes name a call."""
    return f"{gid.hex()}:{abs(sequence)}"


def goal_id(raw: bytes) -> str:
    """How pictures of all processes name a goal."""
    return f"goal:{raw.hex()}"


@dataclass(frozen=True, slots=True)
class Slot:
    """Wait for a slot of a group, to come back to it."""

    group: str
    ticket: int


@dataclass(frozen=True, slots=True)
class Join:
    """Wait for the end of another activity."""

    activity: str


@dataclass(frozen=True, slots=True)
class SetBy:
    """Wait for something that, as far as the source code tells, only these handlers and activities bring about."""

    what: str
    """In words: `self.arrived`."""
    queues: tuple[str, ...]
    activities: tuple[str, ...] = ()
    is_held: bool = False
    """Whether it is a lock or its like, which those activities hold."""


@dataclass(frozen=True, slots=True)
class All:
    """Wait for every one of these."""

    of: tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class AnyOf:
    """Wait for one of these, whichever."""

    of: tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class Free:
    """Wait for what the picture does not show: time, a thread, the outside world."""


FREE = Free()
Condition = Call | Slot | Join | SetBy | All | AnyOf | Free


@dataclass(frozen=True, slots=True)
class ActivityView:
    """A run of a handler, or a task."""

    id: str
    label: str
    """Method and kind: `tick`, `service add`."""
    node: str
    holds: tuple[str, ...] = ()
    """The groups of which it holds a slot."""
    wait: Condition = FREE
    serves: str = ""
    """The call or goal that it answers."""
    place: Place = field(default_factory=lambda: Place(""))
    """Where it waits."""
    function: str = ""
    age: float = 0.0
    """Seconds that it has waited."""
    left: float | None = None
    """Seconds until its call times out; None if never."""
    process: str = ""
    is_inner: bool = False
    """Whether it is graphflow's, and nothing that users have written."""
    is_async: bool = True
    """Whether `await` can stand where it waits."""


@dataclass(frozen=True, slots=True)
class GroupView:
    """A concurrency group of a node, or a handler's own queue, which is as good as a group of its own."""

    id: str
    name: str
    """Empty for a handler's own queue."""
    node: str
    limit: int | None = 1
    is_declared: bool = True
    """Whether the class or a graph file names it, and not only what makes handlers while the node runs."""
    is_threaded: bool = False


@dataclass(frozen=True, slots=True)
class QueueView:
    """What waits to be handled by one handler."""

    id: str
    label: str
    node: str
    needs: tuple[str, ...]
    """The groups of which the next run takes a slot."""
    calls: tuple[str, ...] = ()
    """Calls and goals that wait, in order."""
    waiting: int = 0
    """Items that wait, of whatever kind."""
    dropped: int = 0
    process: str = ""
    is_declared: bool = True
    """Whether the handler stands in the class, so that a graph file can move it."""


@dataclass(frozen=True, slots=True)
class WaitGraph:
    """Who waits for whom in one process, or in several. No group has the id of an activity."""

    activities: Mapping[str, ActivityView] = field(default_factory=dict)
    groups: Mapping[str, GroupView] = field(default_factory=dict)
    queues: Mapping[str, QueueView] = field(default_factory=dict)
    blocked: Mapping[str, str] = field(default_factory=dict)
    """By process whose loop is blocked: the activity that blocks it."""


def joined(pictures: Iterable[WaitGraph]) -> WaitGraph:
    """Several processes as one picture."""
    activities: dict[str, ActivityView] = {}
    groups: dict[str, GroupView] = {}
    queues: dict[str, QueueView] = {}
    blocked: dict[str, str] = {}
    for graph in pictures:
        activities.update(graph.activities)
        groups.update(graph.groups)
        queues.update(graph.queues)
        blocked.update(graph.blocked)
    return WaitGraph(activities, groups, queues, blocked)
