"""Keeping a running graph reachable: its run file and control socket are restored when they are removed."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from pathlib import Path

from graphflow.errors import SupervisorError
from graphflow.supervisor.control.server import ControlServer
from graphflow.supervisor.processes.successor import GuardianWatch
from graphflow.supervisor.rundir import GraphRun, RunDirectory
from graphflow.supervisor.supervisor import Supervisor
from graphflow.system import is_portable

CHECK_EVERY = 2.0
"""Seconds between two checks of the files and the guardian."""


async def keep_reachable(
    supervisor: Supervisor, control: ControlServer, directory: RunDirectory, run: GraphRun
) -> None:
    """Restore removed files, as after a logout; stop the graph if that fails, for no verb could stop it then.

    It also replaces a guardian that has ended, which only the supervisor can notice.
    """
    guard = GuardianWatch(run)
    while True:
        if text := guard.check():
            supervisor.note(text)
        if guard.run is not run:
            run = guard.run
            with suppress(OSError):  # a missing directory is restored below
                directory.write(run)
        await asyncio.sleep(CHECK_EVERY)
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
            supervisor.begin_stop(now=False, reason=f"its {what} was removed: {error}")
            return
        supervisor.note(f"the {what} was removed, and has been restored")
