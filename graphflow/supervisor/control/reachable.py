"""The run file and the control socket, by which verbs find a running graph: made again when they are removed."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from pathlib import Path

from graphflow.errors import SupervisorError
from graphflow.supervisor.control.server import ControlServer
from graphflow.supervisor.processes.successor import Guard
from graphflow.supervisor.rundir import GraphRun, RunDirectory
from graphflow.supervisor.supervisor import Supervisor
from graphflow.system import is_portable

LOOK_EVERY = 2.0
"""Seconds between two looks whether they and the guardian are still there."""


async def keep_reachable(
    supervisor: Supervisor, control: ControlServer, directory: RunDirectory, run: GraphRun
) -> None:
    """Make what is taken away, as at a logout, again; else stop, for no verb could do it.

    Also sees to it that there is a guardian, whose end only the supervisor can see.
    """
    guard = Guard(run)
    while True:
        if words := guard.look():
            supervisor.note(words)
        if guard.run is not run:
            run = guard.run
            with suppress(OSError):  # what is missing is made again below
                directory.write(run)
        await asyncio.sleep(LOOK_EVERY)
        is_there, has_socket = directory.is_there(run), is_portable() or Path(run.socket).is_socket()
        if is_there and has_socket:
            continue
        what = "control socket" if is_there else "run directory"
        try:
            if not is_there:
                directory.restore()
            if not is_portable():
                await control.open(directory.socket)
            if not is_there:
                directory.write(run)
        except (OSError, SupervisorError) as error:
            supervisor.begin_stop(now=False, reason=f"its {what} was taken away: {error}")
            return
        supervisor.note(f"the {what} was taken away, and was made again")
