"""Workers forked from the preload process: on Linux this starts twenty nodes in a tenth of a second."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from graphflow.errors import SupervisorError
from graphflow.machines.process import Exit
from graphflow.supervisor.control.channel import Lines
from graphflow.supervisor.processes import preload, process_tree
from graphflow.supervisor.processes.guardian import GRACE
from graphflow.supervisor.processes.jobs import Start

if TYPE_CHECKING:
    from graphflow.supervisor.processes import messages

REAP_LIMIT = 1.0
"""Seconds that the preload process has to report how a worker ended."""
END_LIMIT = 2.0
"""Seconds that the preload process has to end."""


class ForkingStarter:
    """See `starter.Starter`."""

    def __init__(self, keep: tuple[int, ...]) -> None:
        self._channel, self._status, self._pid = preload.start(keep)
        self._preload: Lines[messages.PreloadEvent]
        self._reports: Lines[messages.ProcessEvent]
        self._workers: dict[int, tuple[str, int]] = {}
        """Living workers by process id: the name of each, and the pidfd that becomes readable at its end, or -1."""
        self._programs: dict[str, signal.Signals] = {}
        """Processes that are foreign programs."""
        self._early: dict[str, list[messages.ProcessEvent]] = {}
        """Events of workers that were started ahead and not spawned yet."""
        self._on_event: Callable[[messages.ProcessEvent], None]
        self._lost: Callable[[str], None]
        self._is_open = self._has_ended = False
        self._ending: asyncio.Task[None] | None = None

    def begin_probe(self, classes: Sequence[str], root: str) -> None:
        request: messages.ProbeRequest = {"do": "probe", "classes": list(classes), "root": root}
        with suppress(ConnectionError):  # it has ended, as `probed` finds out
            self._send_blocking(request)

    def _send_blocking(self, request: messages.PreloadRequest) -> None:
        """Send a request before the loop runs."""
        self._channel.sendall(json.dumps(request).encode() + b"\n")

    def probed(self) -> messages.InterfacesJson:
        data = b""
        while not data.endswith(b"\n"):
            try:
                chunk = self._channel.recv(65536)
            except ConnectionError:
                chunk = b""
            if not chunk:
                raise SupervisorError(f"{self._end_in_words()} before the graph was up")
            data += chunk
        answer: messages.PreloadEvent = json.loads(data)
        if answer["event"] == "broken":
            raise SupervisorError(f"process {self._pid}, which starts the nodes, failed:\n{answer['trace']}")
        assert answer["event"] == "probed"
        return answer["interfaces"]

    def _end_in_words(self) -> str:
        """Wait for the preload process, which has ended, and describe how."""
        _, status = os.waitpid(self._pid, 0)
        self._has_ended = True
        how = Exit.of_status(os.waitstatus_to_exitcode(status))
        return f"process {self._pid}, which starts the nodes, was ended by {how}"

    def begin(self, starts: Iterable[Start]) -> None:
        for start in starts:
            self._early[start.process] = []
            with suppress(ConnectionError):  # it has ended, as is reported once this is open
                self._send_blocking(_spawn_request(*start))

    async def open(
        self, log: Path, on_event: Callable[[messages.ProcessEvent], None], lost: Callable[[str], None]
    ) -> None:
        self._on_event, self._lost = on_event, lost
        self._preload = Lines(self._channel, self._take_answer, self._lose)
        self._reports = Lines(self._status, self._report, _ignore_end_of_reports)
        self._is_open = True
        request: messages.LogRequest = {"do": "log", "path": str(log)}
        self._preload.send(request)

    def _report(self, event: messages.ProcessEvent) -> None:
        """Report an event of a worker; keep it for later if the worker has not been spawned yet."""
        early = self._early.get(event.get("process", ""))
        if early is None:
            self._on_event(event)
        else:
            early.append(event)

    def _take_answer(self, event: messages.PreloadEvent) -> None:
        """Take in an answer of the preload process."""
        if event["event"] == "broken" or event["event"] == "probed":
            return  # a broken one has written why to the log, and its end is reported in a moment
        if event["event"] == "spawned":
            self._watch(event["process"], event["pid"])
        elif event["event"] == "exited":
            pid = event.get("pid")
            if pid in self._workers:
                self._ended(pid, event["status"])
            if pid is not None:
                return  # `_ended` has reported it, or `_give_up` had before
        self._report(event)

    def _watch(self, process: str, pid: int) -> None:
        """Learn of a worker's end from the kernel: the preload process may be stopped."""
        try:
            end = os.pidfd_open(pid)
        except OSError:  # it has ended and was reaped: the preload process's report is on its way
            self._workers[pid] = (process, -1)
            return
        self._workers[pid] = worker = (process, end)
        asyncio.get_running_loop().add_reader(end, self._saw_end, pid, worker)

    def _saw_end(self, pid: int, worker: tuple[str, int]) -> None:
        loop = asyncio.get_running_loop()
        loop.remove_reader(worker[1])
        loop.call_later(REAP_LIMIT, self._give_up, pid, worker)

    def _give_up(self, pid: int, worker: tuple[str, int]) -> None:
        """Report an end without its cause, unless that is known by now; another worker may have the pid then."""
        if self._workers.get(pid) is worker and not self._has_ended:
            self._ended(pid, None)

    def _ended(self, pid: int, status: int | None) -> None:
        process, end = self._workers.pop(pid)
        if end >= 0:
            asyncio.get_running_loop().remove_reader(end)
            os.close(end)
        self._reports.read()  # events that the worker wrote before its end are in the pipe, and come first
        self._report({"event": "exited", "process": process, "status": status})

    def trouble(self) -> str:
        if process_tree.state_of(self._pid) != "T":
            return ""
        return f"process {self._pid}, which starts the nodes, is stopped; to let it go on: kill -CONT {self._pid}"

    def _lose(self) -> None:
        """Report that the preload process has ended, and end its workers, whose parent is this process now.

        The kernel has sent SIGTERM to the workers (`system.end_with_parent`); foreign programs get it here.
        """
        self._lost(self._end_in_words())
        for pid, (name, _) in self._workers.items():
            if name in self._programs:
                process_tree.kill_group(pid, signal.SIGTERM)
        self._ending = asyncio.create_task(self._end_workers())

    async def _end_workers(self) -> None:
        deadline = time.monotonic() + GRACE
        while self._workers and time.monotonic() < deadline:
            self._reap()
            await asyncio.sleep(0.01)
        process_tree.end_descendants(os.getpid(), self._reap)
        for pid in list(self._workers):
            self._ended(pid, None)

    def _reap(self) -> None:
        for pid, status in process_tree.reaped():
            if pid in self._workers:
                self._ended(pid, status)

    def spawn(self, process: str, job: messages.Job, log: str, env: dict[str, str]) -> None:
        if process in self._early:
            # Not at once: the supervisor is still in the middle of the transition that called this.
            asyncio.get_running_loop().call_soon(self._report_early_events, process)
            return
        if "command" in job:
            self._programs[process] = signal.Signals[job["signal"]]
        self._preload.send(_spawn_request(process, job, log, env))

    def _report_early_events(self, process: str) -> None:
        for event in self._early.pop(process):
            self._on_event(event)

    def send_order(self, process: str, order: messages.Order) -> None:
        request: messages.OrderRequest = {"do": "tell", "process": process, "order": order}
        self._preload.send(request)

    def terminate(self, process: str, pid: int) -> None:
        process_tree.kill_group(pid, self._programs.get(process, signal.SIGTERM))

    def kill(self, process: str, pid: int) -> None:
        process_tree.kill_group(pid, signal.SIGKILL)

    async def close(self) -> None:
        if self._ending is not None:
            await self._ending
        if self._is_open:
            self._preload.close()
            self._reports.close()

    def end(self) -> None:
        # When it reads the end of this socket, the preload process ends all workers and itself.
        self._channel.close()
        deadline = time.monotonic() + END_LIMIT
        while not self._has_ended:
            self._has_ended = bool(os.waitpid(self._pid, os.WNOHANG)[0])
            if time.monotonic() > deadline:  # it is stopped
                process_tree.kill(self._pid, signal.SIGKILL)
            time.sleep(0 if self._has_ended else 0.002)
        process_tree.end_descendants(os.getpid(), process_tree.reap_children)


def _spawn_request(process: str, job: messages.Job, log: str, env: dict[str, str]) -> messages.SpawnRequest:
    return {"do": "spawn", "process": process, "job": job, "log": log, "env": env}


def _ignore_end_of_reports() -> None:
    """Do nothing: the workers' pipe ends with the preload process, whose end `_lose` reports."""
