"""One process of a graph, as its supervisor sees it."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence
from typing import Any

from graphflow.errors import SupervisorError
from graphflow.graph.plan import PlannedNode
from graphflow.machines.process import ALARMS, BLOCKED_STOP_LIMIT, Exit, State
from graphflow.machines.restarts import BACKOFF, Restarts

BLOCKED_AFTER = 1.5
"""Seconds of silence after which a loop, which beats once a second, counts as blocked when its process is ended."""


class Process:
    """A worker with its nodes, or a foreign program.

    Args:
        name: The process's name: that of its node, unless several share it.
        log: The file that its output goes to.
    """

    def __init__(self, name: str, nodes: list[PlannedNode], log: str) -> None:
        self.name = name
        self.nodes = nodes
        self.log = log
        self.state = State.PENDING
        self.pid: int | None = None
        self.exit: Exit | None = None
        """How it ended, of a process that has."""
        self.since = time.time()
        """When the process entered its state, in seconds since 1970."""
        self.ready_since: float | None = None
        """When it was ready, on the monotonic clock."""
        self.heard: float | None = None
        """When its event loop last said that it goes round, on the monotonic clock; None for never."""
        self.silent_since: float | None = None
        """Since when it has said nothing, if that is too long."""
        self.waiting_for = {n.name for n in nodes}
        """Nodes that are not ready yet."""
        self.numbers = {node.name: number for number, node in enumerate(nodes, 1)}
        """The numbers by which nodes of the process are unloaded."""
        self.lifecycle: dict[str, str] = {}
        """The states of its lifecycle nodes."""
        self.error = ""
        self.log_error = ""
        """Why lines of its log were lost."""
        self.starts = 0
        self.stop_asked = False
        self.failed = False
        """Whether the process ended by itself with a failure."""
        self.given_up = ""
        """Why it is not started again, though it should be."""
        self.delay = 0.0
        """Seconds until it is started again, from the moment on in which it ended."""
        self.last_end = ""
        """How the one before this one ended, by itself."""
        self.alarm: asyncio.TimerHandle | None = None
        self.alarm_after: float | None = None
        """Seconds that the process may stay in its state; None for any time."""
        self.blocks_loop = False
        """Whether handlers block its event loop, and are to run in threads from the next start on."""
        policies = [node.restart for node in nodes if node.restart != BACKOFF]
        self.restarts = Restarts(policies[0] if policies else BACKOFF)
        self.ends_graph = any(node.on_exit == "shutdown" for node in nodes)
        self.is_debugged = any(node.is_debugged for node in nodes)
        self.is_critical = any(node.critical for node in nodes)

    @property
    def is_program(self) -> bool:
        """Whether it is a foreign program, and no worker."""
        return bool(self.nodes[0].command)

    def put_in_threads(self, node: str, handlers: Sequence[str]) -> PlannedNode:
        """Have handlers of a node run in threads, whenever it is started; returns how it is planned now.

        Raises:
            SupervisorError: Its code alone says what runs in threads.
        """
        if self.is_program:
            raise SupervisorError(f"{node} is a program: its own code says what runs in threads")
        at = next(i for i, planned in enumerate(self.nodes) if planned.name == node)
        self.nodes[at] = self.nodes[at].with_threads(handlers)
        self.blocks_loop = True
        return self.nodes[at]

    def may_stay(self, now: float) -> float | None:
        """Seconds that it may stay in its state; None for any time.

        Args:
            now: Seconds on the monotonic clock.
        """
        if self.state is State.WAITING:
            return self.delay
        if self.is_debugged and self.state is State.STARTING:
            return None  # whoever debugs it has all the time in the world
        is_blocked = self.blocks_loop and self.heard is not None and now - self.heard > BLOCKED_AFTER
        return BLOCKED_STOP_LIMIT if is_blocked and self.state is State.RESTARTING else ALARMS.get(self.state)

    @property
    def word(self) -> str:
        """Its state, as `ps` has it."""
        if self.state is State.ENDED and self.given_up:
            return "given_up"
        if self.state is State.READY and self.silent_since is not None:
            return "unresponsive"
        return "failed" if self.state is State.ENDED and self.failed else self.state.value

    @property
    def detail(self) -> str:
        """What is wrong with it."""
        if self.state is State.WAITING:
            left = max(0.0, self.since + self.delay - time.time())
            return f"{self.error or self.exit}; it is started again in {left:.1f} s"
        if self.given_up:
            return f"{self.error or self.exit}; given up: {self.given_up}"
        if self.error:
            return self.error
        if self.word == "unresponsive" and self.silent_since is not None:
            return f"its event loop has said nothing for {time.monotonic() - self.silent_since:.0f} s"
        if self.exit is not None and self.exit.failed:
            return str(self.exit)
        return f"its log is not written whole: {self.log_error}" if self.log_error else ""

    def rows(self) -> list[dict[str, Any]]:
        """One row per node, for `ps`."""
        return [
            {
                "node": node.name,
                "is_named": bool(node.class_path or node.executable) and not node.keeps_names,
                "state": self.word,
                "lifecycle": self.lifecycle.get(node.name, "") if self.word == "ready" else "",
                "pid": self.pid,
                "since": self.since,
                "process": node.process,
                "number": self.numbers[node.name],
                "class": node.what,
                "log": self.log,
                "restarts": max(0, self.starts - 1),
                "detail": self.detail,
                "last_end": self.last_end,
            }
            for node in self.nodes
        ]

    def begin(self) -> None:
        """Forget what became of the process before this one."""
        self.starts += 1
        self.pid, self.exit, self.ready_since = None, None, None
        self.heard = self.silent_since = None
        self.lifecycle = {}
        self.numbers = {node.name: number for number, node in enumerate(self.nodes, 1)}
        self.error = self.log_error = self.given_up = ""
        self.stop_asked = self.failed = self.blocks_loop = False
        self.waiting_for = {n.name for n in self.nodes}

    @property
    def ready_for(self) -> float:
        """Seconds since it was ready."""
        return 0.0 if self.ready_since is None else time.monotonic() - self.ready_since
