"""Whether and when a process that has ended is started again.

    on_failure   after a signal or an exit code other than 0
    always       after any end that nobody asked for
    never        not at all

The first new start comes after `delay`, each further one after twice as long, up to `max_delay`, all of it up to 20 %
more or less so that processes which failed together do not come back together. After `CALM` seconds in which it was
ready, a process counts as well again. One that has been started again `max_restarts` times `within` so many seconds is
given up. An exit code of 64 to 78 says that what was given to the process is wrong: a new start would be no help.

Source: Erlang's supervisors (intensity), systemd's StartLimitBurst; sysexits(3) for the codes.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import Literal, get_args

from graphflow.machines.process import Exit

Policy = Literal["never", "on_failure", "always"]
POLICIES: tuple[str, ...] = get_args(Policy)
CALM = 30.0
"""Seconds of being ready after which earlier failures are forgotten."""
JITTER = 0.2
"""The part of a delay by which it may be longer or shorter."""
CONFIGURATION = range(64, 79)
"""Exit codes that mean wrong usage or configuration, but for that of an error in the node."""
NODE_ERROR = 70


@dataclass(frozen=True, slots=True)
class Backoff:
    """How a process is started again."""

    policy: Policy = "never"
    delay: float = 0.1
    """Seconds before the first new start."""
    max_delay: float = 10.0
    max_restarts: int = 5
    within: float = 30.0
    """Seconds in which so many new starts are too many."""

    def __str__(self) -> str:
        times = f"{self.max_restarts} times in {self.within:g} s"
        return f"{self.policy}, after {self.delay:g} to {self.max_delay:g} s, up to {times}"


BACKOFF = Backoff()


@dataclass(frozen=True, slots=True)
class Again:
    """Start it again after so many seconds."""

    delay: float


@dataclass(frozen=True, slots=True)
class GiveUp:
    """It is not started again, though its policy asks for it."""

    why: str


@dataclass
class Restarts:
    """The new starts of one process."""

    backoff: Backoff
    _failures: int = 0
    """New starts since it was last well."""
    _times: deque[float] = field(default_factory=deque)
    """When the latest new starts were decided."""

    def decide(self, end: Exit, ready_for: float, now: float, chance: float) -> Again | GiveUp | None:
        """What follows from an end that nobody asked for; None if the policy leaves it at that.

        Args:
            end: How the process ended.
            ready_for: Seconds for which it had been ready.
            now: The time in seconds, on a clock that never goes back.
            chance: A random number between 0 and 1.
        """
        backoff = self.backoff
        if backoff.policy == "never" or (backoff.policy == "on_failure" and not end.failed):
            return None
        if end.code is not None and end.code in CONFIGURATION and end.code != NODE_ERROR:
            return GiveUp(f"{end} does not get better by starting it again")
        if ready_for >= CALM:
            self._failures = 0
        while self._times and now - self._times[0] > backoff.within:
            self._times.popleft()
        if len(self._times) >= backoff.max_restarts:
            return GiveUp(f"started again {len(self._times)} times within {backoff.within:g} s")
        self._times.append(now)
        delay = min(backoff.delay * 2.0 ** min(self._failures, 60), backoff.max_delay)
        self._failures += 1
        return Again(delay * (1.0 - JITTER + 2.0 * JITTER * chance))

    def forget(self) -> None:
        """Begin anew: somebody has started the process by hand."""
        self._failures = 0
        self._times.clear()
