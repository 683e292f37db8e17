"""How a graphflow process shows itself in a domain, and where it answers other processes.

@graphflow/<domain>/proc/<zid>/<uid>/<pid>/<host>    the token of a process
@graphflow/<domain>/<what>/<zid>                     its answers: `answer_key`
"""

from __future__ import annotations

import os
from typing import NamedTuple

from graphflow.system import host_name, user_id
from graphflow.wire.liveliness import TOKEN_BOUND, whole_number


class ProcessToken(NamedTuple):
    """What a process says about itself."""

    zid: str
    """The id of its session."""
    user: str
    pid: int
    host: str

    def __str__(self) -> str:
        return f"process {self.pid}" if self.host == host_name() else f"process {self.pid} on {self.host}"

    @property
    def why_silent(self) -> str:
        """What may keep the process from answering, and what to do about it."""
        if self.host == host_name() and is_stopped(self.pid):
            return f"it is stopped: kill -CONT {self.pid}"
        return "it is stopped, or something holds its interpreter, or it cannot be reached"

    @property
    def command(self) -> str:
        """The command that started the process, where this system can tell."""
        try:
            words = _bytes(f"/proc/{self.pid}/cmdline").split(b"\0") if self.host == host_name() else []
        except OSError:
            return ""
        return b" ".join(words).decode(errors="replace").strip()


def token(domain: int, zid: str) -> str:
    """This process's own token."""
    return f"@graphflow/{domain}/proc/{zid}/{user_id()}/{os.getpid()}/{host_name()}"


def watch_key(domain: int) -> str:
    """The key that matches all process tokens of a domain."""
    return f"@graphflow/{domain}/proc/**"


WAITS, NUMBERS, LOOK, GROUPS, GOALS = "waits", "numbers", "look", "groups", "goals"
"""What a process answers; see `deadlock.inspection` and `runtime.reasons`."""


def answer_key(domain: int, what: str, zid: str = "*") -> str:
    """Where the processes of a domain answer."""
    return f"@graphflow/{domain}/{what}/{zid}"


def parse(text: str) -> ProcessToken | None:
    """Read a token; None if the text is not one."""
    parts = text.split("/") if len(text) <= TOKEN_BOUND and text.isprintable() else []
    if len(parts) != 7 or parts[0] != "@graphflow" or parts[2] != "proc":
        return None
    pid = whole_number(parts[5])
    return None if pid is None else ProcessToken(parts[3], parts[4], pid, parts[6])


def is_stopped(pid: int) -> bool:
    """Whether a process of this machine is stopped, as by Ctrl-Z or a debugger; False where the system does not say."""
    return _state(pid) in ("T", "t")


def stopped() -> dict[int, str]:
    """The stopped processes of this machine that may be of this graph, by number: a sentence each with the next step.

    The network forgets a process that does not answer for some seconds; the system knows it, on Linux.
    """
    found = {}
    for pid in sorted(int(name) for name in _listed("/proc") if name.isdecimal()):
        try:
            if is_stopped(pid) and b"zenoh" in _bytes(f"/proc/{pid}/maps") and _rendezvous_of(pid) == _rendezvous():
                command = _bytes(f"/proc/{pid}/cmdline").replace(b"\0", b" ").decode(errors="replace").strip()
                found[pid] = f"process {pid}, {command}, is stopped: kill -CONT {pid}"
        except OSError:  # it has ended, or is another user's
            continue
    return found


def _listed(folder: str) -> list[str]:
    try:
        return os.listdir(folder)
    except OSError:  # another system
        return []


def _rendezvous_of(pid: int) -> str:
    words = _bytes(f"/proc/{pid}/environ").split(b"\0")
    return next((os.fsdecode(w.partition(b"=")[2]) for w in words if w.startswith(b"GRAPHFLOW_RENDEZVOUS=")), "")


def _rendezvous() -> str:
    return os.environ.get("GRAPHFLOW_RENDEZVOUS", "")


def _state(pid: int) -> str:
    """Linux's letter for a process's state."""
    try:
        return _bytes(f"/proc/{pid}/stat").decode(errors="replace").rpartition(")")[2].split()[0]
    except (OSError, IndexError):
        return ""


def _bytes(path: str) -> bytes:
    with open(path, "rb") as file:
        return file.read()
