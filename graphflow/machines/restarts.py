"""The restart policy of a process: exponential backoff with jitter and a limit.

    on_failure   restart after a signal or an exit code other than 0
    always       restart after any end that was not requested
    never        do not restart

The first restart comes after `delay`, each further one after twice the time, up to `max_delay`. Jitter of 20 % spreads
processes that failed together. A process that was ready for `CALM` seconds starts again with the first delay. After
`max_restarts` restarts `within` a number of seconds there is no other. An exit code from 64 to 78, except 70, means
wrong usage or configuration, which no restart would change.

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
"""Fraction by which a delay may be longer or shorter."""
CONFIGURATION = range(64, 79)
"""Exit codes for wrong usage or configuration, with one exception: `NODE_ERROR`."""
NODE_ERROR = 70
"""Exit code for an error in the node."""


@dataclass(frozen=True, slots=True)
class Backoff:
    """The parameters of a restart policy."""

    policy: Policy = "never"
    delay: float = 0.1
    """Seconds before the first restart."""
    max_delay: float = 10.0
    """Seconds before any later restart, at most."""
    max_restarts: int = 5
    within: float = 30.0
    """Seconds in which `max_restarts` restarts are allowed."""

    def __str__(self) -> str:
        times = f"{self.max_restarts} times in {self.within:g} s"
        return f"{self.policy}, after {self.delay:g} to {self.max_delay:g} s, up to {times}"


BACKOFF = Backoff()


@dataclass(frozen=True, slots=True)
class Again:
    """The decision to restart a process."""

    delay: float
    """Seconds until the restart."""


@dataclass(frozen=True, slots=True)
class GiveUp:
    """The decision not to restart a process although its policy asks for it."""

    why: str


@dataclass
class Restarts:
    """The restarts of one process."""

    backoff: Backoff
    _failures: int = 0
    """Restarts since the process was last ready for `CALM` seconds."""
    _times: deque[float] = field(default_factory=deque)
    """Times of the latest restarts."""

    def decide(self, end: Exit, ready_for: float, now: float, chance: float) -> Again | GiveUp | None:
        """Decide about an end that was not requested; None if the policy does not ask for a restart.

        Args:
            end: The end of the process.
            ready_for: Seconds for which it had been ready.
            now: The time in seconds, on a monotonic clock.
            chance: A random number between 0 and 1, for the jitter.
        """
        backoff = self.backoff
        if backoff.policy == "never" or (backoff.policy == "on_failure" and not end.failed):
            return None
        if end.code is not None and end.code in CONFIGURATION and end.code != NODE_ERROR:
            return GiveUp(f"a restart would not change {end}")
        if ready_for >= CALM:
            self._failures = 0
        while self._times and now - self._times[0] > backoff.within:
            self._times.popleft()
        if len(self._times) >= backoff.max_restarts:
            return GiveUp(f"started again {len(self._times)} times within {backoff.within:g} s")
        self._times.append(now)
        # Bounded, since a power beyond the floats raises OverflowError.
        delay = min(backoff.delay * 2.0 ** min(self._failures, 60), backoff.max_delay)
        self._failures += 1
        return Again(delay * (1.0 - JITTER + 2.0 * JITTER * chance))

    def forget(self) -> None:
        """Forget earlier failures, as after a restart by hand."""
        self._failures = 0
        self._times.clear()
