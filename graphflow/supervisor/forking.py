"""Workers forked from the preload process: used on Linux, where it starts twenty nodes in a tenth of a second."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from graphflow.errors import SupervisorError
from graphflow.supervisor import preload
from graphflow.supervisor.channel import Lines
from graphflow.supervisor.starter import Heard


class ForkingStarter:
    """See `starter.Starter`."""

    def __init__(self, keep: tuple[int, ...]) -> None:
        self._channel, self._status, self._pid = preload.start(keep)
        self._lines: list[Lines] = []

    def begin_probe(self, classes: Sequence[str], root: str) -> None:
        self._channel.sendall(json.dumps({"do": "probe", "classes": list(classes), "root": root}).encode() + b"\n")

    def probed(self) -> dict[str, Any]:
        data = b""
        while not data.endswith(b"\n"):
            chunk = self._channel.recv(65536)
            if not chunk:
                raise SupervisorError("the process that imports node classes died")
            data += chunk
        result: dict[str, Any] = json.loads(data)["interfaces"]
        return result

    async def open(self, log: Path, heard: Heard, lost: Callable[[], None]) -> None:
        status = Lines(self._status, heard, lambda: None)

        def heard_of_end(event: dict[str, Any]) -> None:
            if event["event"] == "exited":  # what the worker said before it ended is in the pipe, and comes first
                status.read()
            heard(event)

        self._lines = [Lines(self._channel, heard_of_end, lost), status]
        self._lines[0].send(do="log", path=str(log))

    def spawn(self, process: str, job: dict[str, Any], log: str, env: dict[str, str]) -> None:
        self._lines[0].send(do="spawn", process=process, job=job, log=log, env=env)

    def terminate(self, process: str, pid: int) -> None:
        _signal(pid, signal.SIGTERM)

    def kill(self, process: str, pid: int) -> None:
        _signal(pid, signal.SIGKILL)

    async def close(self) -> None:
        for lines in self._lines:
            lines.close()

    def end(self) -> None:
        self._channel.close()
        os.waitpid(self._pid, 0)


def _signal(pid: int, number: signal.Signals) -> None:
    try:
        os.killpg(pid, number)
    except ProcessLookupError:  # it has ended, or has not made its process session yet
        try:
            os.kill(pid, number)
        except ProcessLookupError:
            return
