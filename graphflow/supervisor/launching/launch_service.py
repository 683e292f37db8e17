"""Launch descriptions that a program starts itself, by a `LaunchService`: `graphflow up` does it with the same file."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
import threading
from typing import Any

import graphflow.launchfiles.python.functions  # noqa: F401 - which belong to the packages, too
from graphflow.launchfiles.python.recording import RECORDING
from graphflow.launchfiles.python.stand_ins import OWN, RecordedCall
from graphflow.supervisor.launching.command_output import printed

RECORDING.run = printed


class Described(BaseException):
    """A program that is run to describe itself would start a description now; `SystemExit` must not be in the way.

    Attributes:
        description: What was included.
    """

    def __init__(self, description: list[Any]) -> None:
        super().__init__()
        self.description = description


class LaunchService(RecordedCall):
    """What starts a description from a program.

    Args:
        argv: Arguments of the description, `name:=value`.
    """

    kind = "LaunchService"

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._included: list[Any] = []
        self._up: subprocess.Popen[bytes] | None = None

    def include_launch_description(self, description: Any) -> None:
        """Add a description to what is started."""
        self._included.append(description)

    def run(self, **_: Any) -> int:
        """Start it, and wait for its end; returns the exit code. Ctrl-C stops it."""
        if RECORDING.file:
            raise Described(self._included)
        file = os.path.abspath(sys.argv[0])
        given = [word for word in self.get("argv", default=None) or () if ":=" in word]
        command = [sys.executable, "-m", "graphflow", "up", "--no-console", file, *given]
        self._up = subprocess.Popen(command, env=os.environ | {"GRAPHFLOW_ENDS_WITH": str(os.getpid())})
        is_main = threading.current_thread() is threading.main_thread()
        former = signal.signal(signal.SIGTERM, self.shutdown) if is_main else None
        try:
            return self._wait(self._up)
        finally:
            if is_main:
                signal.signal(signal.SIGTERM, former)

    @staticmethod
    def _wait(up: subprocess.Popen[bytes]) -> int:
        while True:
            try:
                return up.wait()
            except KeyboardInterrupt:
                continue  # the command has heard it as well, and stops what it has started

    async def run_async(self, **_: Any) -> int:
        """The same in an event loop."""
        if RECORDING.file:
            raise Described(self._included)
        return await asyncio.to_thread(self.run)

    def shutdown(self, *_: Any, **__: Any) -> None:
        """Stop it."""
        if self._up is not None and self._up.poll() is None:
            self._up.send_signal(signal.SIGINT)


OWN[LaunchService.kind] = LaunchService
