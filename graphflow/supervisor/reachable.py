"""What verbs need to find a graph that runs: made again when it is taken away."""

from __future__ import annotations

import asyncio
import os

from graphflow.errors import SupervisorError
from graphflow.supervisor.control import ControlServer
from graphflow.supervisor.rundir import GraphRun, RunDirectory
from graphflow.supervisor.supervisor import Supervisor
from graphflow.system import is_portable

LOOK_EVERY = 2.0
"""Seconds between two looks whether they and the guardian are still there."""


async def keep_reachable(
    supervisor: Supervisor, control: ControlServer, directory: RunDirectory, run: GraphRun
) -> None:
    """Make the run directory again when it is taken away, as at a logout; else stop, for no verb could do it.

    Also says so when the guardian has ended, which only its children can see.
    """
    guardian = run.guardian
    while True:
        if guardian and os.getppid() != guardian:
            supervisor.note(f"{run.unguarded}; the graph goes on without it")
            guardian = 0
        await asyncio.sleep(LOOK_EVERY)
        if directory.is_there(run):
            continue
        try:
            directory.restore()
            if not is_portable():
                await control.open(directory.socket)
            directory.write(run)
        except (OSError, SupervisorError) as error:
            supervisor.begin_stop(now=False, reason=f"its run directory was taken away: {error}")
            return
        supervisor.note("the run directory was taken away, and was made again")
