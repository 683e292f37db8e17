"""The tokens of graphflow processes in a domain, and the keys at which they answer queries.

@graphflow/<domain>/proc/<zid>/<uid>/<pid>/<host>    the token of a process
@graphflow/<domain>/<what>/<zid>                     the key of its answers: `answer_key`
"""

from __future__ import annotations

import os
from typing import NamedTuple

from graphflow.domain import DOMAIN_VARIABLES, ENDPOINT_VARIABLE
from graphflow.system import host_name, user_id
from graphflow.wire.liveliness import TOKEN_BOUND, whole_number


class ProcessToken(NamedTuple):
    """A process as its token describes it."""

    zid: str
    """The Zenoh id of its session."""
    user: str
    pid: int
    host: str

    def __str__(self) -> str:
        return f"process {self.pid}" if self.host == host_name() else f"process {self.pid} on {self.host}"

    @property
    def why_silent(self) -> str:
        """Explain why the process may not answer, with the remedy."""
        if self.host == host_name() and is_stopped(self.pid):
            return f"it is stopped: kill -CONT {self.pid}"
        return "it is stopped, or something holds its interpreter, or it cannot be reached"

    @property
    def command(self) -> str:
        """The command line of the process, where this system can read it."""
        try:
            args = _bytes(f"/proc/{self.pid}/cmdline").split(b"\0") if self.host == host_name() else []
        except OSError:
            return ""
        return b" ".join(args).decode(errors="replace").strip()


def token(domain: int, zid: str) -> str:
    """Return this process's own token."""
    return f"@graphflow/{domain}/proc/{zid}/{user_id()}/{os.getpid()}/{host_name()}"


def watch_key(domain: int) -> str:
    """Return the key that matches all process tokens of a domain."""
    return f"@graphflow/{domain}/proc/**"


WAITS, NUMBERS, LOOK, GROUPS, GOALS = "waits", "numbers", "look", "groups", "goals"
"""Kinds of answers; see `deadlock.inspection` and `runtime.reasons`."""


def answer_key(domain: int, what: str, zid: str = "*") -> str:
    """Return the key at which the processes of a domain answer."""
    return f"@graphflow/{domain}/{what}/{zid}"


def parse(text: str) -> ProcessToken | None:
    """Read a token; None if the text is not one."""
    parts = text.split("/") if len(text) <= TOKEN_BOUND and text.isprintable() else []
    if len(parts) != 7 or parts[0] != "@graphflow" or parts[2] != "proc":
        return None
    pid = whole_number(parts[5])
    return None if pid is None else ProcessToken(parts[3], parts[4], pid, parts[6])


def is_stopped(pid: int) -> bool:
    """Return whether a local process is stopped, as by Ctrl-Z or a debugger; False if the system cannot tell."""
    return _state(pid) in ("T", "t")


def stopped(domain: int) -> dict[int, str]:
    """Describe the stopped processes of this machine that may be in a domain, by pid, each with its next step.

    The network forgets a process that does not answer for some seconds; Linux still lists it.
    """
    found = {}
    for pid in sorted(int(name) for name in _listed("/proc") if name.isdecimal()):
        try:
            # Whatever its program: each process of a graph has Zenoh's library in memory.
            if is_stopped(pid) and b"zenoh" in _bytes(f"/proc/{pid}/maps") and _is_in(domain, pid):
                command = _bytes(f"/proc/{pid}/cmdline").replace(b"\0", b" ").decode(errors="replace").strip()
                found[pid] = f"process {pid}, {command}, is stopped: kill -CONT {pid}"
        except OSError:  # it has ended, or belongs to another user
            continue
    return found


def _listed(folder: str) -> list[str]:
    try:
        return os.listdir(folder)
    except OSError:  # not Linux
        return []


def _is_in(domain: int, pid: int) -> bool:
    """Whether a process was started with a domain, and with the rendezvous of this one."""
    lines = (os.fsdecode(line).partition("=") for line in _bytes(f"/proc/{pid}/environ").split(b"\0"))
    variables = {name: value.strip() for name, _, value in lines}
    its = next((variables[name] for name in DOMAIN_VARIABLES if variables.get(name)), "0")
    return its == str(domain) and variables.get(ENDPOINT_VARIABLE, "") == os.environ.get(ENDPOINT_VARIABLE, "")


def _state(pid: int) -> str:
    """Return Linux's letter for the state of a process."""
    try:
        # The name of the program, in parentheses, may itself contain spaces and parentheses.
        return _bytes(f"/proc/{pid}/stat").decode(errors="replace").rpartition(")")[2].split()[0]
    except (OSError, IndexError):
        return ""


def _bytes(path: str) -> bytes:
    with open(path, "rb") as file:
        return file.read()
