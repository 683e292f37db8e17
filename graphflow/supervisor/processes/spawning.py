"""Workers in interpreters of their own: the portable way, for systems without forking or signals.

A worker gets its job over stdin, connects to a port of the supervisor on loopback and shows a token. Over that
connection it sends events and receives orders; when the connection breaks, either side knows that the other is dead.
"""

from __future__ import annotations

import asyncio
import hmac
import json
import logging
import os
import secrets
import signal
import subprocess
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import psutil

from graphflow.supervisor.launching import probe
from graphflow.supervisor.processes.jobs import Start
from graphflow.supervisor.processes.preload import sweep
from graphflow.system import detached

if TYPE_CHECKING:
    from graphflow.supervisor.processes.messages import InterfacesJson, Job, Order, ProcessEvent

logger = logging.getLogger("graphflow.supervisor")

_LAST_EVENTS_LIMIT = 1.0
"""Seconds that the last events of a worker that has ended may take to arrive."""


class SpawningStarter:
    """See `starter.Starter`."""

    def __init__(self) -> None:
        self._probing: subprocess.Popen[bytes] | None = None
        self._classes: Sequence[str] = ()
        self._token = secrets.token_hex(16)
        self._server: asyncio.Server | None = None
        self._on_event: Callable[[ProcessEvent], object] = logger.debug
        self._workers: dict[str, asyncio.Task[None]] = {}
        self._processes: dict[str, asyncio.subprocess.Process] = {}
        self._connections: dict[str, asyncio.StreamWriter] = {}
        self._disconnected: dict[str, asyncio.Event] = {}
        """Set when a worker's connection has ended."""
        self._programs: dict[str, signal.Signals] = {}
        """Processes that are foreign programs."""

    def begin_probe(self, classes: Sequence[str], root: str) -> None:
        self._classes = classes
        self._probing = probe.begin(classes, root)

    def probed(self) -> InterfacesJson:
        assert self._probing is not None
        return probe.finish(self._probing, self._classes)

    def begin(self, starts: Iterable[Start]) -> None:
        """Do nothing: workers need the loop and its port."""

    async def open(self, log: Path, on_event: Callable[[ProcessEvent], None], lost: Callable[[str], None]) -> None:
        self._on_event = on_event
        self._server = await asyncio.start_server(self._accept, "127.0.0.1", 0)

    async def _accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        process = ""
        try:
            hello = json.loads(await reader.readline())
            if not hmac.compare_digest(str(hello["token"]), self._token):
                return
            process = str(hello["process"])
            self._connections[process] = writer
            while line := await reader.readline():
                self._on_event(json.loads(line))
        except (ConnectionError, ValueError, KeyError, TypeError) as error:
            logger.debug("a worker's connection: %s", error)
        finally:
            writer.close()
            if process:
                del self._connections[process]
                self._disconnected[process].set()

    def trouble(self) -> str:
        return ""

    def spawn(self, process: str, job: Job, log: str, env: dict[str, str]) -> None:
        self._disconnected[process] = asyncio.Event()
        if "command" in job:
            self._programs[process] = signal.SIGTERM if os.name == "nt" else signal.Signals[job["signal"]]
        self._workers[process] = asyncio.create_task(self._live(process, job, log, env), name=process)

    async def _live(self, process: str, job: Job, log: str, env: dict[str, str]) -> None:
        """Run one worker from its start to its end."""
        assert self._server is not None
        port = self._server.sockets[0].getsockname()[1]
        try:
            with open(os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600), "ab") as out:
                program = _command(job)
                worker = await asyncio.create_subprocess_exec(
                    *(program or (sys.executable, "-P", "-m", "graphflow.supervisor.processes.worker", str(port))),
                    stdin=asyncio.subprocess.DEVNULL if program else asyncio.subprocess.PIPE,
                    stdout=out,
                    stderr=out,
                    env={**os.environ, **env},
                    **detached(),  # a terminal's Ctrl-C is for `up` alone, which stops the graph in order
                )
        except (OSError, ValueError) as error:  # no memory, no free process, an impossible environment
            self._on_event({"event": "failed", "process": process, "error": f"cannot be started: {error}"})
            self._on_event({"event": "exited", "process": process, "status": 1})
            return
        self._processes[process] = worker
        self._on_event({"event": "spawned", "process": process, "pid": worker.pid})
        try:
            if worker.stdin is not None:
                worker.stdin.write(json.dumps({"token": self._token, "job": job}).encode())
                worker.stdin.close()
                await worker.stdin.wait_closed()
        except ConnectionError:  # it is already dead, as the next line finds out
            logger.debug("%s did not read its job", process)
        status = await worker.wait()
        if hasattr(os, "killpg"):
            sweep(worker.pid)
        # The end is reported last: events that the worker has sent before may still be on their way.
        if process in self._connections:
            try:
                async with asyncio.timeout(_LAST_EVENTS_LIMIT):
                    await self._disconnected[process].wait()
            except TimeoutError:
                logger.debug("%s has ended, its connection has not", process)
        self._on_event({"event": "exited", "process": process, "status": status})

    def send_order(self, process: str, order: Order) -> None:
        connection = self._connections.get(process)
        if connection is not None:
            connection.write(json.dumps(order).encode() + b"\n")

    def terminate(self, process: str, pid: int) -> None:
        connection = self._connections.get(process)
        if connection is not None:
            connection.write(b'{"do": "stop"}\n')
        elif process in self._programs:
            self._processes[process].send_signal(self._programs[process])
        else:  # it has not connected yet
            self.kill(process, pid)

    def kill(self, process: str, pid: int) -> None:
        try:
            members = [psutil.Process(pid), *psutil.Process(pid).children(recursive=True)]
        except psutil.NoSuchProcess:
            return
        for member in members:
            try:
                member.kill()
            except psutil.NoSuchProcess:
                continue

    async def close(self) -> None:
        if self._server is not None:
            self._server.close()
        for process, worker in self._processes.items():
            if worker.returncode is None:
                self.kill(process, worker.pid)
        if self._workers:
            await asyncio.wait(self._workers.values())

    def end(self) -> None:
        """Do nothing: `close` has released everything."""


def _command(job: Job) -> list[str]:
    """Return the command of a foreign program; empty for a worker."""
    if "command" in job:
        return job["command"]
    return []
