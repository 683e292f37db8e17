"""Timers: periodic runs of a handler that skip missed periods and keep the phase."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any, NamedTuple

from graphflow.executor.clock import period_ns
from graphflow.executor.groups import HandlerGroup
from graphflow.executor.runner import Runner, RunnerSpec, title_of
from graphflow.interface import OnError
from graphflow.runtime.mistakes.overruns import Overruns
from graphflow.runtime.mistakes.rclpy_words import with_argument_hints
from graphflow.runtime.part import Host, Part


class TimerInfo(NamedTuple):
    """Due time and actual start of a timer's run, in nanoseconds of the clock, and the number of runs missed."""

    expected_ns: int
    actual_ns: int
    skipped: int


class Timer(Part):
    """A timer: skips missed periods, keeps its phase, and has at most one run at a time.

    Source: rcl timer.c.
    """

    opens_last = True

    @with_argument_hints
    def __init__(
        self,
        host: Host,
        period_ns: int,
        callback: Callable[..., object],
        label: str,
        group: HandlerGroup | None = None,
        *,
        takes_info: bool = False,
        on_error: OnError = "budget",
    ) -> None:
        self.host = host
        self.skipped = 0
        """Periods missed since the start, because a run or its wait for a slot took too long."""
        self._period_ns = period_ns
        self._label = label
        self._callback = callback
        self._takes_info = takes_info
        self._group = group
        self._on_error = on_error
        self._next_ns = 0
        self._handle: Any = None
        self._due: deque[TimerInfo] = deque()
        self.runner: Runner | None = None
        self._missed = 0
        self._overruns, self._outlasted = Overruns(host, self.title), 0
        self._was_armed = False

    def __repr__(self) -> str:
        return f"<Timer {self._label} {self._period_ns / 1e9:g} s>"

    @property
    def handler_title(self) -> str:
        return title_of("timer", self._label)

    @property
    def title(self) -> str:
        return f"timer {self._label}"

    def statistics(self) -> dict[str, object]:
        """Return the numbers of runs, failed runs and skipped periods since the start."""
        runs, errors = (0, 0) if self.runner is None else (self.runner.runs, self.runner.errors)
        return {"runs": runs, "errors": errors, "skipped": self.skipped}

    def complaints(self) -> list[str]:
        return self._overruns.complaints()

    @property
    def calls(self) -> tuple[object, ...]:
        return self._callback, self._period_ns

    @property
    def period(self) -> float:
        """Seconds between runs. Setting it restarts the timer: the next run is one new period away.

        Raises:
            ValueError: The new value is not a positive number.
        """
        return self._period_ns / 1e9

    @period.setter
    def period(self, seconds: float) -> None:
        self._period_ns = period_ns(seconds, None)
        if self.runner is not None:
            self.reset()

    def open(self) -> None:
        """Start the timer. Called by the node."""
        tell = (self._invoke, self._finished, self.host.full_name)
        self.runner = self.host.runner(
            RunnerSpec(self._label, *tell, "timer", self._refused, wants_results=False), self._due, self._group
        )
        self.reset()

    def reset(self) -> None:
        """Restart the timer: the next run is one period from now."""
        self._arm(self.host.clock.monotonic_ns() + self._period_ns)

    def clock_changed(self) -> None:
        """Restart a running timer on the node's new clock."""
        if self._handle is not None:
            self.reset()

    def _arm(self, when_ns: int) -> None:
        if self.runner is None or self.runner.closed:
            return
        self.host.context.refuse_other_threads(f"{self.title}: reset")
        if self._handle is not None:
            self._handle.cancel()
        self._next_ns = when_ns
        self._handle = self.host.clock.call_at(when_ns, self._fire)

    def _fire(self) -> None:
        assert self.runner is not None
        now, due = self.host.clock.monotonic_ns(), self._next_ns
        late = max(0, (now - due) // self._period_ns)
        # First, so that a handler that cancels or resets the timer has the last word.
        self._arm(due + (1 + late) * self._period_ns)
        self.skipped += late
        self._missed += late
        if self._due or self.runner.active:
            self.skipped += 1
            self._missed += 1
            if not self._due:
                self.runner.stalled()  # its own previous run is still in progress
                self._outlasted += 1
                self._overruns.in_the_way(self.runner.active, self._outlasted, now, self._period_ns)
            return
        self._due.append(TimerInfo(due, now, self._missed))
        self._overruns.begins(self._outlasted)
        self._missed = self._outlasted = 0
        self.runner.wake()

    def _invoke(self, info: TimerInfo) -> Any:
        return self._callback(info) if self._takes_info else self._callback()

    def _finished(self, info: TimerInfo, result: object, error: BaseException | None) -> None:
        if error is not None:
            self.host.handler_failed(self._label, error, self._on_error)

    def _refused(self, info: TimerInfo) -> None:
        self.skipped += 1
        self._missed += 1

    def cancel(self) -> None:
        """Stop the timer; `reset` restarts it."""
        if self._handle is not None:
            self.host.context.refuse_other_threads(f"{self.title}: cancel")
            self._handle.cancel()
            self._handle = None

    def begin_to_stop(self) -> Runner | None:
        self.cancel()
        return self.runner

    def pause(self, why: str) -> Runner | None:
        super().pause(why)
        self._was_armed = self._handle is not None
        return self.begin_to_stop()

    def resume(self) -> Runner | None:
        """Start a new period, unless the timer was cancelled."""
        super().resume()
        if self.runner is not None:
            self.runner.reopen()
            if self._was_armed:
                self.reset()
        return self.runner

    def close(self) -> None:
        """Stop for good and cancel a run in progress."""
        self.cancel()
        if self.runner is not None:
            self.runner.cancel()
        self.host.forget(self)
