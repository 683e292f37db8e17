"""Sockets that a forked child must not keep: they would hold a port after the end of the process that opened it.

A child, such as a process pool's, inherits all descriptors and none of Zenoh's threads: nobody would answer there.
"""

from __future__ import annotations

import os
import stat
import sys
from contextlib import suppress


def leave_port(port: int) -> None:
    """Let children that are forked from now on not keep the sockets of a TCP port of this machine."""
    if not _ports and sys.platform != "win32":
        os.register_at_fork(after_in_child=_leave)
    _ports.add(port)


_ports: set[int] = set()


def _leave() -> None:
    try:
        descriptors = [int(name) for name in os.listdir("/proc/self/fd")]
    except OSError:  # not Linux
        return
    for descriptor in descriptors:
        with suppress(OSError):  # that of the listing itself is closed by now
            if stat.S_ISSOCK(os.fstat(descriptor).st_mode) and _is_of_port(descriptor):
                # Replaced and not closed: what believes to own the descriptor must not close another's later.
                nothing = os.open(os.devnull, os.O_RDWR | os.O_CLOEXEC)
                os.dup2(nothing, descriptor, inheritable=False)
                os.close(nothing)


def _is_of_port(descriptor: int) -> bool:
    """Whether a socket listens on one of the ports, or was accepted there."""
    import socket  # commands fork no children, and start faster without it

    with socket.socket(fileno=os.dup(descriptor)) as found:
        return found.family in (socket.AF_INET, socket.AF_INET6) and found.getsockname()[1] in _ports
