"""A user's own project with nodes that wait for each other, for tests of deadlocks between real processes.

The nodes are those of `tests/programs/`; one waits at its gate until the test opens it, so that rings close when they
should.
"""

from __future__ import annotations

import json
import re
import shutil
import signal
import subprocess
from pathlib import Path

from tests.conftest import PROGRAMS, Machine, Program


class Lab:
    """A user's own project, on a machine of its own."""

    def __init__(self, machine: Machine, root: Path) -> None:
        self.machine, self.root = machine, root
        (root / "nodes").mkdir(parents=True)
        (root / "pyproject.toml").touch()
        self.add("deadlock/ring.py")

    def add(self, program: str, name: str = "") -> None:
        """Take one of `tests/programs/` among the project's nodes, under another file name if one is given."""
        shutil.copy(PROGRAMS / program, self.root / "nodes" / name)

    def write(self, nodes: dict[str, str], *, policy: str = "report", name: str = "lab") -> str:
        """Write a graph of these nodes; calls that say nothing else wait for ever."""
        lines = "".join(f"  {node}: {{{about}}}\n" for node, about in nodes.items())
        (self.root / f"{name}.yaml").write_text(f"deadlock: {policy}\ncall_timeout: never\nnodes:\n{lines}")
        return f"{name}.yaml"

    def up(self, nodes: dict[str, str], *, policy: str = "report") -> Program:
        return self.machine.start("up", self.write(nodes, policy=policy), cwd=self.root)

    def up_fixed(self, lines: str) -> Program:
        """Start the graph with some lines changed."""
        (self.root / "fixed.yaml").write_text(f"include: lab.yaml\noverride:\n{lines}\n")
        return self.machine.start("up", "fixed.yaml", cwd=self.root)

    def open_gates(self, *names: str) -> None:
        for name in names:
            (self.root / "nodes" / f"open.{name}").touch()

    def ring(self, names: str, *, policy: str = "report") -> Program:
        """Close a ring of processes."""
        up = self.up(ring_of(names), policy=policy)
        wait_for_all(up, at_it(names))
        self.open_gates(*names)
        return up

    def pids(self) -> dict[str, int]:
        # By a process, which takes a while: those who did not report a ring find it in that time, too, and only then
        # can tell of its end when the one who did report it has died. Nothing shows when they have.
        return {row["node"]: row["pid"] for row in json.loads(self.machine.run("ps", "--json"))}

    def call(self, service: str) -> None:
        assert "success=True" in self.machine.look("service", "call", service, "std_srvs/srv/Trigger")


def ring_of(names: str, cls: str = "Member") -> dict[str, str]:
    """Members of which each asks the next, and the last the first."""
    pairs = zip(names, names[1:] + names[0], strict=True)
    return {f"/{name}": member(next_one, cls) for name, next_one in pairs}


def member(following: str, cls: str = "Member", more: str = "") -> str:
    return f"class: nodes.ring:{cls}, remap: {{following: /{following}/answer}}{more}"


def echo_of(name: str) -> str:
    return f"class: nodes.ring:Echo, remap: {{back: /{name}/answer}}"


def at_it(names: str) -> list[str]:
    return [f"[{name}]: is at it" for name in names]


def answered(names: str) -> list[str]:
    return [f"[{name}]: was answered" for name in names]


def wait_for_all(up: Program, texts: list[str]) -> None:
    for text in texts:
        up.wait_for(text)


def line_of(marker: str, program: str = "deadlock/ring.py") -> int:
    """The number of the line that ends with a comment of this text."""
    lines = (PROGRAMS / program).read_text().splitlines()
    [line] = [number for number, text in enumerate(lines, 1) if text.endswith(f"# {marker}")]
    return line


def at(marker: str) -> str:
    """How a report tells the line that ends with the marker."""
    return f"(ring.py:{line_of(marker)} in "


def wait_for_ring(up: Program, names: str) -> None:
    """Wait until the ring has been reported, every member with its line."""
    up.wait_for(f"DEADLOCK: {len(names)} callbacks wait for each other in a ring")
    line = f"{at('stuck: Member')}toil, called in ring.py:"
    for name, other in zip(names, names[1:] + names[0], strict=True):
        up.wait_for(
            f"timer ask of /{name} holds group 'work' and waits for the response of service /{other}/answer   {line}"
        )
        up.wait_for(f"service answer of /{other} waits for group 'work' of /{other}, which timer ask of /{other} holds")
    up.wait_for("release the slot while waiting, in ring.py:")


def zids(up: Program) -> dict[str, str]:
    """The ids of the members' processes; of those who find a ring, the first reports it."""
    return dict(re.findall(r"\[(\w)\]: is at it \((\w+)\)", up.text))


def reporter(up: Program) -> str:
    """The node in whose log the report stands."""
    found = re.search(r"(?m)^(\w+) +\| \[ERROR\] \[\S+\] \[graphflow\]: DEADLOCK", up.text)
    assert found is not None
    return found[1]


PATIENCE = 0.7
"""Seconds that the processes of a graph get to end by themselves."""


def reports(*texts: str) -> list[str]:
    """The headlines of the deadlocks that were told."""
    return [headline for text in texts for headline in re.findall(r"\[graphflow\]: ((?:LIKELY )?DEADLOCK: .*)", text)]


def seconds_to_report(text: str) -> float:
    """From the call that closed the ring to the report, by the times in the log."""

    def times(what: str) -> list[float]:
        return [float(when) for when in re.findall(rf"\[(\d+\.\d+)\] \[\w+\]: {what}", text)]

    return min(times("DEADLOCK")) - max(times("asks"))


def end_at_once(up: Program) -> None:
    """End a graph of which a process may be blocked, without waiting for that as long as `up` does."""
    up.process.send_signal(signal.SIGINT)
    up.wait_for("stopping (Ctrl-C)")
    try:
        code = up.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        code = up.end()  # a second Ctrl-C kills
        if code == -signal.SIGINT:  # it came when `up` had all but ended, and Python no longer caught signals
            return
    assert code == 0, f"{code}\n{up.text}"
