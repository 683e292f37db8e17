r"""The life of one supervised process, as a table.

    PENDING --go--> STARTING --ready--> READY --stop--> STOPPING --exit--> ENDED
                        \-----------------exit-----------------------------^
                    STARTING, READY --restart--> RESTARTING --exit--> STARTING
                    STARTING, READY --reset----> RESETTING --exit---> PENDING
                    ENDED --again--> WAITING --late--> STARTING
                    ENDED, WAITING -------------restart-------------> STARTING

A process waits (PENDING) until what it comes `after` is there. It is READY when all its nodes have said so themselves.
Stopping is a ladder: SIGTERM, a time to clean up, SIGKILL; `kill` goes to the last rung at once. Whatever happens,
`exit` is the only way to ENDED, so nothing is called ended that may still be running. An end that nobody asked for is
judged by how it came: `failed` is true when the process ended by a signal or with a code other than 0.

Starting again, when somebody asks for it, is stopping with another end: the process is STARTING again when it has gone.
A process that ended by itself and is to be started again (`machines.restarts` decides) is WAITING for its time. One
that is reset because another has failed waits, PENDING, for what it comes after, as at first.

Source: docs/architecture.md, "The rules of processes"; systemd's and Erlang's stop sequences.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

START_LIMIT = 20.0
"""Seconds a process may take from its start until all its nodes are ready."""
STOP_LIMIT = 5.0
"""Seconds between SIGTERM and SIGKILL."""
BLOCKED_STOP_LIMIT = 0.5
"""The same for a process whose event loop is blocked by handlers that are to run in threads: it cannot clean up."""


class State(Enum):
    PENDING = "pending"
    STARTING = "starting"
    READY = "ready"
    STOPPING = "stopping"
    RESTARTING = "restarting"
    """Stopping, to be started again."""
    RESETTING = "resetting"
    """Stopping, to be started again when what it comes after is there."""
    WAITING = "waiting"
    """It has ended, and is started again when its time has come."""
    ENDED = "ended"


class Event(Enum):
    GO = "go"
    """What the process comes after is ready."""
    READY = "ready"
    """The last of its nodes is ready."""
    STOP = "stop"
    KILL = "kill"
    RESTART = "restart"
    """Somebody asks for a new process in place of this one."""
    AGAIN = "again"
    """It has ended by itself, and is to be started again after a while."""
    RESET = "reset"
    """Another process has failed, with which it begins anew."""
    LATE = "late"
    """The alarm set on entering the state has rung."""
    EXIT = "exit"


class Do(Enum):
    SPAWN = "spawn"
    TERMINATE = "terminate"
    """SIGTERM to the whole process group."""
    KILL = "kill"
    """SIGKILL to the whole process group."""
    GIVE_UP = "give up"
    """The process was not ready in time: report it."""


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
"""Events that a state does not list change nothing."""

ALARMS: Mapping[State, float] = {
    State.STARTING: START_LIMIT,
    State.STOPPING: STOP_LIMIT,
    State.RESTARTING: STOP_LIMIT,
    State.RESETTING: STOP_LIMIT,
}
"""Seconds after entering a state at which LATE happens; while WAITING it is as `machines.restarts` says."""


def step(state: State, event: Event) -> tuple[State, tuple[Do, ...]]:
    """What an event does in a state."""
    return TRANSITIONS[state].get(event, (state, ()))


@dataclass(frozen=True)
class Exit:
    """How a process ended: its code, or the signal that ended it; neither, if nobody knows."""

    code: int | None = None
    signal: int | None = None

    @classmethod
    def of_status(cls, returncode: int) -> Exit:
        """From a return code as `subprocess` gives it: negative for a signal."""
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
    """Something that comes before something else."""

    name: str
    """Of a process or step."""
    what: str = "ready"
    """What must have become of it: `ready`, `exited` in any way, or `done`, which is ended well."""


@dataclass(frozen=True)
class Order:
    """What comes before what: processes and steps by name."""

    after: Mapping[str, frozenset[Need]]

    def startable(self, met: Iterable[Need]) -> list[str]:
        """Names all of whose needs are met, in the order given."""
        known = set(met)
        return [name for name, needs in self.after.items() if needs <= known]

    def later(self, processes: Container[str]) -> set[str]:
        """Names that need the end of a process, perhaps of one that another one needs: they may never begin."""
        found: set[str] = set()
        for name in self.after:
            around = {name, *self.all_before(name)}
            needs = [need for other in around for need in self.after.get(other, ())]
            if any(need.what != "ready" and need.name in processes for need in needs):
                found.add(name)
        return found

    def lacking(self, name: str, met: AbstractSet[Need]) -> str:
        """The unmet needs of a name, as a list in words."""
        needs = sorted(self.after[name] - met)
        return ", ".join(need.name if need.what == "ready" else f"the end of {need.name}" for need in needs)

    def stop_layers(self, names: Iterable[str]) -> list[list[str]]:
        """Names in the order of stopping: last started first, those of one layer together."""
        left = list(names)
        layers = []
        while left:
            needed = {n for name in left for n in self.all_before(name)}
            layer = [name for name in left if name not in needed] or left
            layers.append(layer)
            left = [name for name in left if name not in layer]
        return layers

    def all_before(self, name: str) -> set[str]:
        """What comes before something, directly or because of others."""
        found: set[str] = set()
        todo = [name]
        while todo:
            for needed, _ in self.after.get(todo.pop(), ()):
                if needed not in found:
                    found.add(needed)
                    todo.append(needed)
        return found
