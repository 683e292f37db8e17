"""The operating system: the machine, the user, and the choice between Linux's mechanisms and portable ones.

The portable ones are slower to start and use more memory: workers are spawned instead of forked, the control socket is
on loopback with a token instead of a Unix socket, and the event loop is woken as asyncio does it. Windows and macOS use
them; `GRAPHFLOW_PORTABLE=1` selects them on Linux, too, for tests.
"""

from __future__ import annotations

import gc
import os
import re
import sys
from typing import Any

from graphflow.errors import UsageFault

PORTABLE_VARIABLE = "GRAPHFLOW_PORTABLE"
LOOP_VARIABLE = "GRAPHFLOW_LOOP"
"""Environment variable that selects `asyncio` or `uvloop`."""
SITE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "rclpy", "site")
"""The folder of the packages that are imported under ROS's names."""
ROS2 = os.path.join(os.path.dirname(SITE), "bin")
"""The folder of graphflow's program `ros2`."""

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
    """Return whether only portable mechanisms are used."""
    return sys.platform != "linux" or os.environ.get(PORTABLE_VARIABLE, "") not in ("", "0")


def chosen_loop() -> str:
    """Return the kind of event loop that the environment selects; empty for the best one available.

    Raises:
        UsageFault: It is none, or is not installed.
    """
    chosen = os.environ.get(LOOP_VARIABLE, "")
    if chosen not in ("", "asyncio", "uvloop"):
        raise UsageFault(f"{LOOP_VARIABLE} is {chosen!r}; it may be 'asyncio' or 'uvloop'")
    if chosen == "uvloop":
        from importlib.util import find_spec  # hardly anybody chooses

        if find_spec("uvloop") is None:
            raise UsageFault(f"{LOOP_VARIABLE} is 'uvloop', which is not installed: pip install uvloop")
    return chosen


def user_id() -> int:
    """Return the user id of this process; 0 if the system has none."""
    return os.getuid() if hasattr(os, "getuid") else 0


def terminal_name() -> str:
    """Return the terminal of this process, as `who` prints it; the process itself if there is none."""
    try:
        return os.ttyname(0).removeprefix("/dev/")
    except (OSError, AttributeError):
        return f"process {os.getpid()}"


def detached() -> dict[str, Any]:
    """Return options of `subprocess.Popen` for a process that the terminal's Ctrl-C does not reach."""
    create_new_process_group = 0x200
    return {"creationflags": create_new_process_group} if sys.platform == "win32" else {"start_new_session": True}


def offer_ros2() -> None:
    """Put graphflow's `ros2` on the PATH of processes started from now on, unless a ROS 2 is sourced."""
    import shutil

    if shutil.which("ros2") is None:
        os.environ["PATH"] = os.pathsep.join([os.environ.get("PATH", os.defpath), ROS2])
        os.environ["GRAPHFLOW_PYTHON"] = sys.executable


def host_name() -> str:
    """Return this machine's name, as used in liveliness tokens."""
    import platform  # slow to import: a tenth of a listing's time

    return re.sub(r"[^\w.-]", "_", platform.node())


def end_with_parent(pid: int, number: int) -> None:
    """Have Linux send this process a signal when its parent ends for any reason; does nothing on other systems.

    Args:
        pid: The parent, which may have ended already.
        number: The number of the signal.
    """
    if sys.platform != "linux":
        return
    import ctypes

    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, int(number))
    if os.getppid() != pid:  # it ended before prctl, which then sends nothing
        os.kill(os.getpid(), number)
