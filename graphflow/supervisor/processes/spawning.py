"""Workers as interpreters of their own: the portable way, for systems without forking or signals.

A worker gets its job over stdin, connects to a port of the supervisor on loopback and shows a token. Over that
connection it reports its state and is asked to stop; when the connection breaks, either side knows that the other is
dead.
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
from typing import Any

import psutil

from graphflow.supervisor.launching import probe
from graphflow.supervisor.processes.preload import sweep
from graphflow.supervisor.processes.starter import Heard, Start
from graphflow.system import detached

logger = logging.getLogger("graphflow.supervisor")

_LAST_WORDS = 1.0
"""Seconds that a dead worker's last reports may take to arrive."""


class SpawningStarter:
    """See `starter.Starter`."""

    def __init__(self) -> None:
        self._probing: subprocess.Popen[bytes] | None = None
        self._wanted: Sequence[str] = ()
        self._token = secrets.token_hex(16)
        self._server: asyncio.Server | None = None
        self._heard: Heard = logger.debug
        self._workers: dict[str, asyncio.Task[None]] = {}
        self._processes: dict[str, asyncio.subprocess.Process] = {}
        self._voices: dict[str, asyncio.StreamWriter] = {}
        self._silent: dict[str, asyncio.Event] = {}
        """Set when a worker's connection has ended."""
        self._programs: dict[str, signal.Signals] = {}
        """Processes that are foreign programs."""

    def begin_probe(self, classes: Sequence[str], root: str) -> None:
        self._wanted = classes
        self._probing = probe.begin(classes, root)

    def probed(self) -> dict[str, Any]:
        assert self._probing is not None
        return probe.finish(self._probing, self._wanted)

    def begin(self, starts: Iterable[Start]) -> None:
        """Workers need the loop, and the port at which it hears them."""

    async def open(self, log: Path, heard: Heard, lost: Callable[[str], None]) -> None:
        self._heard = heard
        self._server = await asyncio.start_server(self._accept, "127.0.0.1", 0)

    async def _accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        process = ""
        try:
            hello = json.loads(await reader.readline())
            if not hmac.compare_digest(str(hello["token"]), self._token):
                return
            process = str(hello["process"])
            self._voices[process] = writer
            while line := await reader.readline():
                self._heard(json.loads(line))
        except (ConnectionError, ValueError, KeyError, TypeError) as error:
            logger.debug("a worker's connection: %s", error)
        finally:
            writer.close()
            if process:
                del self._voices[process]
                self._silent[process].set()

    def trouble(self) -> str:
        return ""

    def spawn(self, process: str, job: dict[str, Any], log: str, env: dict[str, str]) -> None:
        self._silent[process] = asyncio.Event()
        if "command" in job:
            self._programs[process] = signal.SIGTERM if os.name == "nt" else signal.Signals[job["signal"]]
        self._workers[process] = asyncio.create_task(self._live(process, job, log, env), name=process)

    async def _live(self, process: str, job: dict[str, Any], log: str, env: dict[str, str]) -> None:
        """One worker from its start to its end."""
        assert self._server is not None
        port = self._server.sockets[0].getsockname()[1]
        try:
            with open(os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600), "ab") as out:
                program = job.get("command")
                worker = await asyncio.create_subprocess_exec(
                    *(program or (sys.executable, "-P", "-m", "graphflow.supervisor.processes.worker", str(port))),
                    stdin=asyncio.subprocess.DEVNULL if program else asyncio.subprocess.PIPE,
                    stdout=out,
                    stderr=out,
                    env={**os.environ, **env},
                    **detached(),  # a terminal's Ctrl-C is for `up`, which asks the supervisor
                )
        except (OSError, ValueError) as error:  # no memory, no free process, an impossible environment
            self._heard({"event": "failed", "process": process, "error": f"cannot be started: {error}"})
            self._heard({"event": "exited", "process": process, "status": 1})
            return
        self._processes[process] = worker
        self._heard({"event": "spawned", "process": process, "pid": worker.pid})
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
        if process in self._voices:
            try:
                async with asyncio.timeout(_LAST_WORDS):
                    await self._silent[process].wait()
            except TimeoutError:
                logger.debug("%s has ended, its connection has not", process)
        self._heard({"event": "exited", "process": process, "status": status})

    def tell(self, process: str, order: dict[str, Any]) -> None:
        voice = self._voices.get(process)
        if voice is not None:
            voice.write(json.dumps(order).encode() + b"\n")

    def terminate(self, process: str, pid: int) -> None:
        voice = self._voices.get(process)
        if voice is not None:
            voice.write(b'{"do": "stop"}\n')
        elif process in self._programs:
            self._processes[process].send_signal(self._programs[process])
        else:  # it is not yet able to hear
            self.kill(process, pid)

    def kill(self, process: str, pid: int) -> None:
        try:
            family = [psutil.Process(pid), *psutil.Process(pid).children(recursive=True)]
        except psutil.NoSuchProcess:
            return
        for member in family:
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
        """Nothing is left to give back."""
