"""One process of a graph: its state and history in the supervisor."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

from graphflow.errors import SupervisorError
from graphflow.graph.plan import PlannedNode
from graphflow.machines.process import ALARMS, BLOCKED_STOP_LIMIT, Exit, State
from graphflow.machines.restarts import BACKOFF, Restarts

if TYPE_CHECKING:
    from graphflow.supervisor.control.messages import NodeRow, ProcessExited

logger = logging.getLogger("graphflow.supervisor")

BLOCKED_AFTER = 1.5
"""Seconds without a beat after which the event loop of a process that is being ended counts as blocked."""


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
        """Its end; None if it has not ended."""
        self.since = time.time()
        """Time at which it entered its state, in seconds since 1970."""
        self.ready_since: float | None = None
        """Time at which it became ready, on the monotonic clock."""
        self.last_beat: float | None = None
        """Time of the last beat of its event loop, on the monotonic clock; None before the first."""
        self.silent_since: float | None = None
        """Time of the last beat, if that is too long ago; else None."""
        self.waiting_for = {n.name for n in nodes}
        """Nodes that are not ready yet."""
        self.numbers = {node.name: number for number, node in enumerate(nodes, 1)}
        """The numbers by which nodes of the process are unloaded."""
        self.lifecycle: dict[str, str] = {}
        """The states of its lifecycle nodes."""
        self.error = ""
        self.log_error = ""
        """Reason why lines of its log were lost."""
        self.starts = 0
        self.stop_requested = False
        self.failed = False
        """Whether the process ended by itself with a failure."""
        self.given_up = ""
        """Reason why it is not started again, though its policy is to."""
        self.delay = 0.0
        """Seconds between its end and the next start."""
        self.last_end = ""
        """The last end that caused a restart, in words."""
        self.alarm: asyncio.TimerHandle | None = None
        self.alarm_after: float | None = None
        """Seconds that the process may stay in its state; None for any time."""
        self.blocks_loop = False
        """Whether handlers block its event loop that run in threads from the next start on."""
        policies = [node.restart for node in nodes if node.restart != BACKOFF]
        self.restarts = Restarts(policies[0] if policies else BACKOFF)
        self.ends_graph = any(node.on_exit == "shutdown" for node in nodes)
        self.is_debugged = any(node.is_debugged for node in nodes)
        self.is_critical = any(node.critical for node in nodes)

    @property
    def is_program(self) -> bool:
        """Whether it is a foreign program, not a worker."""
        return bool(self.nodes[0].command)

    def put_in_threads(self, node: str, handlers: Sequence[str]) -> PlannedNode:
        """Plan handlers of a node to run in threads from the next start on; returns the new plan of the node.

        Raises:
            SupervisorError: The node is a foreign program.
        """
        if self.is_program:
            raise SupervisorError(f"{node} is a program: its own code decides what runs in threads")
        at = next(i for i, planned in enumerate(self.nodes) if planned.name == node)
        self.nodes[at] = self.nodes[at].with_threads(handlers)
        self.blocks_loop = True
        return self.nodes[at]

    def may_stay(self, now: float) -> float | None:
        """Return the seconds that it may stay in its state; None for no limit.

        Args:
            now: Seconds on the monotonic clock.
        """
        if self.state is State.WAITING:
            return self.delay
        if self.is_debugged and self.state is State.STARTING:
            return None  # a human attaches the debugger
        is_blocked = self.blocks_loop and self.last_beat is not None and now - self.last_beat > BLOCKED_AFTER
        return BLOCKED_STOP_LIMIT if is_blocked and self.state is State.RESTARTING else ALARMS.get(self.state)

    @property
    def state_name(self) -> str:
        """The state that `ps` shows."""
        if self.state is State.ENDED and self.given_up:
            return "given_up"
        if self.state is State.READY and self.silent_since is not None:
            return "unresponsive"
        return "failed" if self.state is State.ENDED and self.failed else self.state.value

    @property
    def detail(self) -> str:
        """The problem of the process, in words; empty if it has none."""
        if self.state is State.WAITING:
            left = max(0.0, self.since + self.delay - time.time())
            return f"{self.error or self.exit}; it is started again in {left:.1f} s"
        if self.given_up:
            return f"{self.error or self.exit}; given up: {self.given_up}"
        if self.error:
            return self.error
        if self.state_name == "unresponsive" and self.silent_since is not None:
            return f"its event loop has not answered for {time.monotonic() - self.silent_since:.0f} s"
        if self.exit is not None and self.exit.failed:
            return str(self.exit)
        return f"its log is incomplete: {self.log_error}" if self.log_error else ""

    def rows(self) -> list[NodeRow]:
        """Return one row per node, for `ps`."""
        return [
            {
                "node": node.name,
                "is_named": bool(node.class_path or node.executable) and not node.keeps_names,
                "state": self.state_name,
                "lifecycle": self.lifecycle.get(node.name, "") if self.state_name == "ready" else "",
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

    def exit_event(self, end: Exit, *, unexpected: bool, again: float | None) -> ProcessExited:
        """Return the event of its end for the clients.

        Args:
            again: Seconds until it is started again; None if it is not.
        """
        return {
            "event": "exited",
            "process": self.name,
            "nodes": [node.name for node in self.nodes],
            "pid": self.pid,
            "how": str(end),
            "unexpected": unexpected,
            "error": self.error,
            "log": self.log,
            "again": again,
            "given_up": self.given_up,
        }

    def begin(self) -> None:
        """Reset the record for a new process."""
        self.starts += 1
        self.pid, self.exit, self.ready_since = None, None, None
        self.last_beat = self.silent_since = None
        self.lifecycle = {}
        self.numbers = {node.name: number for number, node in enumerate(self.nodes, 1)}
        self.error = self.log_error = self.given_up = ""
        self.stop_requested = self.failed = self.blocks_loop = False
        self.waiting_for = {n.name for n in self.nodes}

    @property
    def ready_for(self) -> float:
        """Seconds since it became ready; 0 if it has not."""
        return 0.0 if self.ready_since is None else time.monotonic() - self.ready_since

    def log_end(self) -> None:
        """Append the end of the process to its log, which it could not do itself."""
        reason = f": {self.error}" if self.error else ""
        try:
            with open(self.log, "a", encoding="utf-8") as file:
                file.write(f"[supervisor] process {self.pid} has ended: {self.exit}{reason}\n")
        except OSError as error:  # a full disk
            logger.error("%s: %s", self.log, error)
