r"""The life cycle of one supervised process, as a table.

    PENDING --go--> STARTING --ready--> READY --stop--> STOPPING --exit--> ENDED
                        \-----------------exit-----------------------------^
                    STARTING, READY --restart--> RESTARTING --exit--> STARTING
                    STARTING, READY --reset----> RESETTING --exit---> PENDING
                    ENDED --again--> WAITING --late--> STARTING
                    ENDED, WAITING -------------restart-------------> STARTING

A process is PENDING until its needs (`after`) are met. It is READY when all its nodes have reported ready. Stopping
escalates: SIGTERM, a time to clean up, SIGKILL; `kill` sends SIGKILL at once. `exit` is the only way to ENDED from a
state with a running process, so no process counts as ended while it may still be running. An end that was not requested
is a failure if it came by a signal or with an exit code other than 0.

A requested restart is a stop with another end: the process is STARTING again when the old one has gone. One that ended
by itself and is to be restarted (`machines.restarts` decides) is WAITING for the delay to pass. One that is reset
because another has failed is PENDING again until its needs are met.

Source: docs/architecture.md, "The rules of processes"; systemd's and Erlang's stop sequences.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

START_LIMIT = 20.0
"""Seconds from the start of a process until all its nodes must be ready."""
STOP_LIMIT = 5.0
"""Seconds between SIGTERM and SIGKILL."""
BLOCKED_STOP_LIMIT = 0.5
"""The same for a process that is restarted because its event loop is blocked: it cannot clean up."""


class State(Enum):
    PENDING = "pending"
    STARTING = "starting"
    READY = "ready"
    STOPPING = "stopping"
    RESTARTING = "restarting"
    """Stopping, to start again at once."""
    RESETTING = "resetting"
    """Stopping, to start again when its needs are met."""
    WAITING = "waiting"
    """Ended, to start again after a delay."""
    ENDED = "ended"


class Event(Enum):
    GO = "go"
    """The needs of the process are met."""
    READY = "ready"
    """The last of its nodes is ready."""
    STOP = "stop"
    KILL = "kill"
    RESTART = "restart"
    """A restart is requested."""
    AGAIN = "again"
    """The process has ended by itself, and restarts after a delay."""
    RESET = "reset"
    """Another process has failed, and this one restarts with it."""
    LATE = "late"
    """The time limit of the state has passed."""
    EXIT = "exit"


class Do(Enum):
    SPAWN = "spawn"
    TERMINATE = "terminate"
    """SIGTERM to the whole process group."""
    KILL = "kill"
    """SIGKILL to the whole process group."""
    GIVE_UP = "give up"
    """Report that the process was not ready in time."""


TRANSITIONS: Mapping[State, Mapping[Event, tuple[State, tuple[Do, ...]]]] = {
    State.PENDING: {
        Event.GO: (State.STARTING, (Do.SPAWN,)),
        Event.STOP: (State.ENDED, ()),
        Event.KILL: (State.ENDED, ()),
    },
    State.STARTING: {
        Event.READY: (State.READY, ()),
        Event.STOP: (State.STOPPING, (Do.TERMINATE,)),
        Event.KILL: (State.STOPPING, (Do.KILL,)),
        Event.RESTART: (State.RESTARTING, (Do.TERMINATE,)),
        Event.RESET: (State.RESETTING, (Do.TERMINATE,)),
        Event.LATE: (State.STOPPING, (Do.GIVE_UP, Do.TERMINATE)),
        Event.EXIT: (State.ENDED, ()),
    },
    State.READY: {
        Event.STOP: (State.STOPPING, (Do.TERMINATE,)),
        Event.KILL: (State.STOPPING, (Do.KILL,)),
        Event.RESTART: (State.RESTARTING, (Do.TERMINATE,)),
        Event.RESET: (State.RESETTING, (Do.TERMINATE,)),
        Event.EXIT: (State.ENDED, ()),
    },
    State.RESTARTING: {
        # Without TERMINATE, which was sent on the way to this state.
        Event.STOP: (State.STOPPING, ()),
        Event.KILL: (State.STOPPING, (Do.KILL,)),
        Event.LATE: (State.RESTARTING, (Do.KILL,)),
        Event.EXIT: (State.STARTING, (Do.SPAWN,)),
    },
    State.RESETTING: {
        Event.STOP: (State.STOPPING, ()),
        Event.KILL: (State.STOPPING, (Do.KILL,)),
        Event.RESTART: (State.RESTARTING, ()),
        Event.LATE: (State.RESETTING, (Do.KILL,)),
        Event.EXIT: (State.PENDING, ()),
    },
    State.STOPPING: {
        Event.KILL: (State.STOPPING, (Do.KILL,)),
        Event.RESTART: (State.RESTARTING, ()),
        Event.LATE: (State.STOPPING, (Do.KILL,)),
        Event.EXIT: (State.ENDED, ()),
    },
    State.WAITING: {
        Event.STOP: (State.ENDED, ()),
        Event.KILL: (State.ENDED, ()),
        Event.RESTART: (State.STARTING, (Do.SPAWN,)),
        Event.RESET: (State.PENDING, ()),
        Event.LATE: (State.STARTING, (Do.SPAWN,)),
    },
    State.ENDED: {
        Event.RESTART: (State.STARTING, (Do.SPAWN,)),
        Event.AGAIN: (State.WAITING, ()),
    },
}
"""The next state and the effects, by state and event; events that a state does not list change nothing."""

ALARMS: Mapping[State, float] = {
    State.STARTING: START_LIMIT,
    State.STOPPING: STOP_LIMIT,
    State.RESTARTING: STOP_LIMIT,
    State.RESETTING: STOP_LIMIT,
}
"""Time limits of states in seconds, after which LATE happens; for WAITING `machines.restarts` gives the delay."""


def step(state: State, event: Event) -> tuple[State, tuple[Do, ...]]:
    """Return the next state and the effects of an event."""
    return TRANSITIONS[state].get(event, (state, ()))


@dataclass(frozen=True)
class Exit:
    """The end of a process: its exit code, or the signal that ended it; neither, if that is unknown."""

    code: int | None = None
    signal: int | None = None

    @classmethod
    def of_status(cls, returncode: int) -> Exit:
        """Convert a return code of `subprocess`, which is negative for a signal."""
        return cls(signal=-returncode) if returncode < 0 else cls(code=returncode)

    @property
    def failed(self) -> bool:
        return self.code != 0

    def __str__(self) -> str:
        if self.signal is not None:
            names = {1: "SIGHUP", 2: "SIGINT", 6: "SIGABRT", 9: "SIGKILL", 11: "SIGSEGV", 15: "SIGTERM"}
            hint = " (killed, perhaps for lack of memory)" if self.signal == 9 else ""
            return f"signal {names.get(self.signal, self.signal)}{hint}"
        if self.code is None:
            return "an end whose cause is not known"
        meaning = {64: " (wrong usage)", 70: " (an error in the node)", 78: " (wrong configuration)"}
        return f"exit code {self.code}{meaning.get(self.code, '')}"


class Need(NamedTuple):
    """A condition on another process or step."""

    name: str
    """Name of the process or step."""
    what: str = "ready"
    """State that it must have reached: `ready`, `exited` in any way, or `done`, that is ended without failure."""


@dataclass(frozen=True)
class Order:
    """The order of processes and steps, by their needs."""

    after: Mapping[str, frozenset[Need]]

    def startable(self, met: Iterable[Need]) -> list[str]:
        """Return the names whose needs are all met, in the order given."""
        known = set(met)
        return [name for name, needs in self.after.items() if needs <= known]

    def later(self, processes: Container[str]) -> set[str]:
        """Return the names that need the end of a process, directly or through others: they may never begin."""
        found: set[str] = set()
        for name in self.after:
            around = {name, *self.all_before(name)}
            needs = [need for other in around for need in self.after.get(other, ())]
            if any(need.what != "ready" and need.name in processes for need in needs):
                found.add(name)
        return found

    def lacking(self, name: str, met: AbstractSet[Need]) -> str:
        """Return the unmet needs of a name, as a phrase."""
        needs = sorted(self.after[name] - met)
        return ", ".join(need.name if need.what == "ready" else f"the end of {need.name}" for need in needs)

    def stop_layers(self, names: Iterable[str]) -> list[list[str]]:
        """Return names in the order of stopping: last started first, those of one layer together."""
        left = list(names)
        layers = []
        while left:
            needed = {n for name in left for n in self.all_before(name)}
            layer = [name for name in left if name not in needed] or left
            layers.append(layer)
            left = [name for name in left if name not in layer]
        return layers

    def all_before(self, name: str) -> set[str]:
        """Return the names that come before one, directly or through others."""
        found: set[str] = set()
        todo = [name]
        while todo:
            for needed, _ in self.after.get(todo.pop(), ()):
                if needed not in found:
                    found.add(needed)
                    todo.append(needed)
        return found
