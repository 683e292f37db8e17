"""`LaunchService` for programs that start their own launch description: it runs `graphflow up` on the same file."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
import threading
from typing import Any

import graphflow.launchfiles.python.functions  # noqa: F401 - registers further names of the launch packages
from graphflow.launchfiles.python.recording import RECORDING
from graphflow.launchfiles.python.stand_ins import OWN, RecordedCall
from graphflow.supervisor.launching.command_output import printed

RECORDING.run = printed


class Described(BaseException):
    """Ends a recorded program where it would start its description. No SystemExit, which programs catch.

    Attributes:
        description: The included descriptions.
    """

    def __init__(self, description: list[object]) -> None:
        super().__init__()
        self.description = description


class LaunchService(RecordedCall):
    """The launch service of a program.

    Args:
        argv: Arguments of the description, `name:=value`.
    """

    kind = "LaunchService"

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._included: list[object] = []
        self._up: subprocess.Popen[bytes] | None = None

    def include_launch_description(self, description: object) -> None:
        """Add a description to be started."""
        self._included.append(description)

    def run(self, **_: object) -> int:
        """Start the descriptions and wait for their end; returns the exit code. Ctrl-C stops them."""
        if RECORDING.file:
            raise Described(self._included)
        file = os.path.abspath(sys.argv[0])
        args = [arg for arg in self.get("argv", default=None) or () if ":=" in arg]
        command = [sys.executable, "-m", "graphflow", "up", "--no-console", file, *args]
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
                continue  # the command got the signal as well, and stops the graph

    async def run_async(self, **_: object) -> int:
        """Run in an event loop; see `run`."""
        if RECORDING.file:
            raise Described(self._included)
        return await asyncio.to_thread(self.run)

    def shutdown(self, *_: object, **__: object) -> None:
        """Stop the descriptions."""
        if self._up is not None and self._up.poll() is None:
            self._up.send_signal(signal.SIGINT)


OWN[LaunchService.kind] = LaunchService
