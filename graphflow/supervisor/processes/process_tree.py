"""Process trees (Linux): find and end all descendants of a process.

A process whose parent ends is adopted by the nearest ancestor that has called `adopt_orphans`. The guardian, the
supervisor and the preload process have: so every process that a node leaves behind, in its session or in one of its
own, stays a descendant of each of them that lives. If all three are killed together, see `orphaned`.

Source: prctl(2), PR_SET_CHILD_SUBREAPER and PR_SET_NAME; proc_pid_stat(5), state, ppid, arg_start and arg_end.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial

_PR_SET_NAME = 15
_PR_SET_CHILD_SUBREAPER = 36
_SCAN_EVERY = 0.005
"""Seconds between two scans for processes that are left."""
END_LIMIT = 5.0
"""Seconds that killed processes may take to disappear: one in uninterruptible sleep (a dead disk) may never end."""


def adopt_orphans() -> None:
    """Become the parent of every descendant whose own parent ends."""
    _prctl(_PR_SET_CHILD_SUBREAPER, 1)


def name_process(name: str, title: str) -> None:
    """Name this process, and its future forks, in lists of processes.

    Args:
        name: For `top`, `pstree` and `ps -o comm`, which show 15 characters.
        title: For `ps aux` and `htop`, in place of the command line; cut to its length.
    """
    _prctl(_PR_SET_NAME, name.encode()[:15])
    if sys.platform == "linux":
        import ctypes

        start, end = _arguments()
        if 0 < start < end:  # emulations of Linux may give zeros
            text = f"graphflow: {title}".encode()[: end - start - 1]
            ctypes.memmove(start, text.ljust(end - start, b"\0"), end - start)


def _arguments() -> tuple[int, int]:
    """Return the start and end address of this process's command line."""
    with open("/proc/self/stat", "rb") as file:
        fields = file.read().rpartition(b")")[2].split()  # from field 3 on
    return int(fields[45]), int(fields[46])


def _prctl(option: int, value: int | bytes) -> None:
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None, use_errno=True).prctl(option, value, 0, 0, 0)


def state_of(pid: int) -> str:
    """Return the state of a process as in /proc: `T` is stopped, `Z` has ended; empty if there is no such process."""
    found = _stat(pid)
    return "" if found is None else found[0]


def descendants(root: int) -> list[int]:
    """Return the living descendants of a process."""
    return _below(root, is_deep=True)


def _below(root: int, *, is_deep: bool) -> list[int]:
    children: dict[int, list[int]] = {}
    dead: set[int] = set()
    for pid in _numbers():
        found = _stat(pid)
        if found is not None:
            state, parent = found
            children.setdefault(parent, []).append(pid)
            if state in "ZX":
                dead.add(pid)
    below: list[int] = []
    todo = [root]
    while todo:
        mine = children.get(todo.pop(), [])
        below += mine
        todo += mine if is_deep else []
    return [pid for pid in below if pid not in dead]


def _numbers() -> list[int]:
    return [int(name) for name in os.listdir("/proc") if name.isdecimal()]


def processes() -> list[int]:
    """Return all living processes."""
    return [pid for pid in _numbers() if state_of(pid) not in ("", "Z", "X")]


def children(root: int) -> list[int]:
    """Return the living children of a process."""
    return _below(root, is_deep=False)


def has_started_any() -> bool:
    """Return whether this process has, or had, children: two system calls, no scan.

    Source: wait(2), ECHILD; getrusage(2), RUSAGE_CHILDREN: every process has page faults.
    """
    import resource  # not on Windows

    try:
        os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
    except ChildProcessError:
        return resource.getrusage(resource.RUSAGE_CHILDREN).ru_minflt > 0
    return True


def environment(pid: int) -> frozenset[bytes]:
    """Return the variables a program was started with, each as `name=value`; for a fork, its parent's."""
    try:
        with open(f"/proc/{pid}/environ", "rb") as file:
            return frozenset(file.read().split(b"\0"))
    except OSError:
        return frozenset()


def files(pid: int) -> set[str]:
    """Return the files that a process has open."""
    found: set[str] = set()
    with suppress(OSError):
        for name in os.listdir(f"/proc/{pid}/fd"):
            with suppress(OSError):
                found.add(os.readlink(f"/proc/{pid}/fd/{name}"))
    return found


def output(pid: int) -> set[str]:
    """Return the files of a process's standard output and error."""
    found: set[str] = set()
    for fd in (1, 2):
        with suppress(OSError):
            found.add(os.readlink(f"/proc/{pid}/fd/{fd}"))
    return found


def _stat(pid: int) -> tuple[str, int] | None:
    """Read the state and parent of a process."""
    try:
        with open(f"/proc/{pid}/stat", "rb") as file:
            state, parent, *_ = file.read().rpartition(b")")[2].split()  # the name in parentheses may contain anything
    except (OSError, ValueError):
        return None
    return state.decode(), int(parent)


def end_descendants(root: int, reap: Callable[[], None]) -> bool:
    """Kill all descendants of a process; see `end_all`."""
    return end_all(partial(descendants, root), reap)


def end_all(find: Callable[[], list[int]], reap: Callable[[], None]) -> bool:
    """Kill processes until none is found; returns False if some are left after `END_LIMIT`.

    Args:
        find: Finds the living ones.
        reap: Called after each round, to reap this process's own children.
    """
    deadline = time.monotonic() + END_LIMIT
    empty = 0
    while empty < 2:  # a process that is adopted during a scan may be missed by it
        left = find()
        for pid in left:
            kill(pid, signal.SIGKILL)
        reap()
        empty = 0 if left else empty + 1
        if time.monotonic() > deadline:
            return False
        if left:
            time.sleep(_SCAN_EVERY)
    return True


def kill(pid: int, number: signal.Signals) -> None:
    """Send a signal to a process, if it still lives and belongs to this user, unlike one that `sudo` started."""
    with suppress(ProcessLookupError, PermissionError):
        os.kill(pid, number)


def kill_group(pid: int, number: signal.Signals) -> None:
    """Send a signal to the process group that a process leads; to it alone if it leads none yet."""
    try:
        os.killpg(pid, number)
    except ProcessLookupError:
        kill(pid, number)
    except PermissionError:  # all its processes belong to other users now
        return


def reaped() -> Iterator[tuple[int, int]]:
    """Reap children that have ended; yields process id and exit code, negative for a signal."""
    while True:
        try:
            pid, status = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return
        if pid == 0:
            return
        yield pid, os.waitstatus_to_exitcode(status)


def reap_children() -> None:
    """Reap all children that have ended."""
    for _ in reaped():
        continue
