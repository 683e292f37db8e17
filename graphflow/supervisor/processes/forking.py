"""Workers forked from the preload process: used on Linux, where it starts twenty nodes in a tenth of a second."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from graphflow.errors import SupervisorError
from graphflow.machines.process import Exit
from graphflow.supervisor.control.channel import Lines
from graphflow.supervisor.processes import preload, process_tree
from graphflow.supervisor.processes.guardian import GRACE
from graphflow.supervisor.processes.starter import Heard, Start

REAP_LIMIT = 1.0
"""Seconds that the preload process has to say how a worker ended."""
END_LIMIT = 2.0
"""Seconds that it has to end itself."""


class ForkingStarter:
    """See `starter.Starter`."""

    def __init__(self, keep: tuple[int, ...]) -> None:
        self._channel, self._status, self._pid = preload.start(keep)
        self._lines: list[Lines] = []
        self._workers: dict[int, tuple[str, int]] = {}
        """Living workers by process id: the name of each, and the descriptor that tells its end."""
        self._programs: dict[str, signal.Signals] = {}
        """Processes that are foreign programs."""
        self._begun: dict[str, list[dict[str, Any]]] = {}
        """What has become of workers that were started and not yet asked for."""
        self._hear: Heard
        self._lost: Callable[[str], None]
        self._has_ended = False
        self._ending: asyncio.Task[None] | None = None

    def begin_probe(self, classes: Sequence[str], root: str) -> None:
        with suppress(ConnectionError):  # it has ended, as `probed` finds out
            self._channel.sendall(json.dumps({"do": "probe", "classes": list(classes), "root": root}).encode() + b"\n")

    def probed(self) -> dict[str, Any]:
        data = b""
        while not data.endswith(b"\n"):
            try:
                chunk = self._channel.recv(65536)
            except ConnectionError:
                chunk = b""
            if not chunk:
                raise SupervisorError(f"{self._end_in_words()} before the graph was up")
            data += chunk
        answer: dict[str, Any] = json.loads(data)
        if answer["event"] == "broken":
            raise SupervisorError(f"process {self._pid}, which starts the nodes, failed:\n{answer['trace']}")
        result: dict[str, Any] = answer["interfaces"]
        return result

    def _end_in_words(self) -> str:
        """Wait for the preload process, which has ended, and say how."""
        _, status = os.waitpid(self._pid, 0)
        self._has_ended = True
        how = Exit.of_status(os.waitstatus_to_exitcode(status))
        return f"process {self._pid}, which starts the nodes, was ended by {how}"

    def begin(self, starts: Iterable[Start]) -> None:
        for start in starts:
            self._begun[start.process] = []
            with suppress(ConnectionError):  # it has ended, as is told once this is open
                self._channel.sendall(json.dumps({"do": "spawn", **start._asdict()}).encode() + b"\n")

    async def open(self, log: Path, heard: Heard, lost: Callable[[str], None]) -> None:
        self._hear, self._lost = heard, lost
        self._lines = [Lines(self._channel, self._told, self._lose), Lines(self._status, self._heard, _nothing)]
        self._lines[0].send(do="log", path=str(log))

    def _heard(self, event: dict[str, Any]) -> None:
        """Report what has become of a worker; of one that was not asked for yet, later."""
        early = self._begun.get(event.get("process", ""))
        if early is None:
            self._hear(event)
        else:
            early.append(event)

    def _told(self, event: dict[str, Any]) -> None:
        """What the preload process says."""
        if event["event"] == "broken":
            return  # it has written why to the log, and its end is told in a moment
        if event["event"] == "spawned":
            self._watch(event["process"], event["pid"])
        elif event["event"] == "exited":
            if event["pid"] in self._workers:
                self._ended(event["pid"], event["status"])
            if event["pid"] is not None:
                return  # an end that was given up on before
        self._heard(event)

    def _watch(self, process: str, pid: int) -> None:
        """Learn of a worker's end from the system: the preload process may be stopped."""
        try:
            end = os.pidfd_open(pid)
        except OSError:  # it has ended, and was waited for: what is said of it is on its way
            self._workers[pid] = (process, -1)
            return
        self._workers[pid] = worker = (process, end)
        asyncio.get_running_loop().add_reader(end, self._saw_end, pid, worker)

    def _saw_end(self, pid: int, worker: tuple[str, int]) -> None:
        loop = asyncio.get_running_loop()
        loop.remove_reader(worker[1])
        loop.call_later(REAP_LIMIT, self._give_up, pid, worker)

    def _give_up(self, pid: int, worker: tuple[str, int]) -> None:
        """Report an end without its cause, unless that is known by now; another worker may have the number then."""
        if self._workers.get(pid) is worker and not self._has_ended:
            self._ended(pid, None)

    def _ended(self, pid: int, status: int | None) -> None:
        process, end = self._workers.pop(pid)
        if end >= 0:
            asyncio.get_running_loop().remove_reader(end)
            os.close(end)
        self._lines[1].read()  # what the worker said before it ended is in the pipe, and comes first
        self._heard({"event": "exited", "process": process, "status": status})

    def trouble(self) -> str:
        if process_tree.state_of(self._pid) != "T":
            return ""
        return f"process {self._pid}, which starts the nodes, is stopped; to let it go on: kill -CONT {self._pid}"

    def _lose(self) -> None:
        """The preload process has ended. The system has asked its workers to do the same; this is their parent now.

        Foreign programs know nothing of that, and are asked here.
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

    def spawn(self, process: str, job: dict[str, Any], log: str, env: dict[str, str]) -> None:
        if process in self._begun:
            asyncio.get_running_loop().call_soon(self._tell_begun, process)
            return
        if "command" in job:
            self._programs[process] = signal.Signals[job["signal"]]
        self._lines[0].send(do="spawn", process=process, job=job, log=log, env=env)

    def _tell_begun(self, process: str) -> None:
        for event in self._begun.pop(process):
            self._hear(event)

    def tell(self, process: str, order: dict[str, Any]) -> None:
        self._lines[0].send(do="tell", process=process, order=order)

    def terminate(self, process: str, pid: int) -> None:
        process_tree.kill_group(pid, self._programs.get(process, signal.SIGTERM))

    def kill(self, process: str, pid: int) -> None:
        process_tree.kill_group(pid, signal.SIGKILL)

    async def close(self) -> None:
        if self._ending is not None:
            await self._ending
        for lines in self._lines:
            lines.close()

    def end(self) -> None:
        self._channel.close()
        deadline = time.monotonic() + END_LIMIT
        while not self._has_ended:
            self._has_ended = bool(os.waitpid(self._pid, os.WNOHANG)[0])
            if time.monotonic() > deadline:  # it is stopped
                process_tree.kill(self._pid, signal.SIGKILL)
            time.sleep(0 if self._has_ended else 0.002)
        process_tree.end_descendants(os.getpid(), process_tree.reap_children)


def _nothing() -> None:
    """The workers' pipe ends with the preload process, whose end is told elsewhere."""
