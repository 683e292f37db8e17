"""This machine, its user, and which of an operating system's ways are taken: Linux's, or those that every system has.

The portable ways are slower to start and cost more memory: workers are started and not forked, the control socket is
on loopback with a token and not a Unix socket, the loop is woken as asyncio does it. Windows and macOS take them;
`GRAPHFLOW_PORTABLE=1` takes them on Linux too, so that they can be tested there.
"""

from __future__ import annotations

import os
import re
import sys
from typing import Any

PORTABLE_VARIABLE = "GRAPHFLOW_PORTABLE"


def is_portable() -> bool:
    """Whether the ways are taken that every system has."""
    return sys.platform != "linux" or os.environ.get(PORTABLE_VARIABLE, "") not in ("", "0")


def user_id() -> int:
    """This process's user, 0 where the system has none."""
    return os.getuid() if hasattr(os, "getuid") else 0


def detached() -> dict[str, Any]:
    """Options of `subprocess.Popen` for a process that a terminal's Ctrl-C does not reach."""
    create_new_process_group = 0x200
    return {"creationflags": create_new_process_group} if sys.platform == "win32" else {"start_new_session": True}


def host_name() -> str:
    """This machine's name, as it stands in tokens."""
    import platform  # importing it takes a tenth of a listing's time

    return re.sub(r"[^\w.-]", "_", platform.node())
