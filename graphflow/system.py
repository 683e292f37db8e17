"""This machine, its user, and which means of the operating system are used: Linux's, or those every system has.

The portable ones start more slowly and cost more memory: workers are spawned instead of forked, the control socket is
on loopback with a token instead of a Unix socket, the loop is woken as asyncio does it. Windows and macOS use them;
`GRAPHFLOW_PORTABLE=1` selects them on Linux too, so that they can be tested there.
"""

from __future__ import annotations

import gc
import os
import re
import sys
from typing import Any

PORTABLE_VARIABLE = "GRAPHFLOW_PORTABLE"
SITE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "rclpy", "site")
"""The folder of what is imported under ROS's names."""
ROS2 = os.path.join(os.path.dirname(SITE), "bin")
"""The folder with a program `ros2`, which is graphflow."""

_COLLECTIONS = gc.get_threshold()


def collect_rarely() -> None:
    """Let the garbage collector run rarely, for as long as a process imports: it finds next to nothing then.

    It takes a twelfth of the time of the imports otherwise.
    """
    gc.set_threshold(50_000, *_COLLECTIONS[1:])


def collect_normally() -> None:
    """Let the garbage collector run as often as at the start of this process."""
    gc.set_threshold(*_COLLECTIONS)


def is_portable() -> bool:
    """Whether only the means that every system has are used."""
    return sys.platform != "linux" or os.environ.get(PORTABLE_VARIABLE, "") not in ("", "0")


def user_id() -> int:
    """This process's user, 0 where the system has none."""
    return os.getuid() if hasattr(os, "getuid") else 0


def terminal_name() -> str:
    """The terminal that this process is used from, as `who` prints it; the process where there is none."""
    try:
        return os.ttyname(0).removeprefix("/dev/")
    except (OSError, AttributeError):
        return f"process {os.getpid()}"


def detached() -> dict[str, Any]:
    """Options of `subprocess.Popen` for a process that a terminal's Ctrl-C does not reach."""
    create_new_process_group = 0x200
    return {"creationflags": create_new_process_group} if sys.platform == "win32" else {"start_new_session": True}


def offer_ros2() -> None:
    """Let what this process starts find a program `ros2`: graphflow, unless a ROS 2 is sourced."""
    import shutil

    if shutil.which("ros2") is None:
        os.environ["PATH"] = os.pathsep.join([os.environ.get("PATH", os.defpath), ROS2])
        os.environ["GRAPHFLOW_PYTHON"] = sys.executable


def host_name() -> str:
    """This machine's name as used in tokens."""
    import platform  # importing it takes a tenth of a listing's time

    return re.sub(r"[^\w.-]", "_", platform.node())


def end_with_parent(pid: int, number: int) -> None:
    """Have the system send this process a signal when its parent ends, however that happens; on Linux only.

    Args:
        pid: The parent, which may have ended already.
        number: The signal's.
    """
    if sys.platform != "linux":
        return
    import ctypes

    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, int(number))
    if os.getppid() != pid:
        os.kill(os.getpid(), number)
