"""A node with children: one in its own session, one in another, and a daemon that is nobody's child."""

from __future__ import annotations

import os
import subprocess
import time

from graphflow import Node


class Nursery(Node):
    """Leaves them to whoever cares."""

    def __init__(self) -> None:
        super().__init__("nursery")
        subprocess.Popen(["sleep", "600"])
        subprocess.Popen(["sleep", "600"], start_new_session=True)
        parent = os.fork()
        if parent == 0:
            os.setsid()
            if os.fork() == 0:
                time.sleep(600)
            os._exit(0)
        os.waitpid(parent, 0)

    async def on_shutdown(self) -> None:
        self.log.info("everybody goes to bed")
