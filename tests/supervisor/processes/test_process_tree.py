"""All that a process has started, however it was started: found, and ended."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator

import pytest

from graphflow.supervisor.processes import process_tree
from tests.conftest import alive
from tests.until import until

pytestmark = [
    pytest.mark.real,
    pytest.mark.skipif(sys.platform != "linux", reason="elsewhere workers end by themselves"),
]

ANCESTOR = """
import os, subprocess, sys, time
from graphflow.supervisor.processes import process_tree

process_tree.adopt_orphans()
child = subprocess.Popen([sys.executable, "-c", '''
import os, subprocess, time
subprocess.Popen(["sleep", "600"])
subprocess.Popen(["sleep", "600"], start_new_session=True)
if os.fork() == 0:  # a daemon: a session of its own, and no parent
    os.setsid()
    if os.fork():
        os._exit(0)
    time.sleep(600)
os.wait()
print("ready", flush=True)
time.sleep(600)
'''], stdout=subprocess.PIPE, env={**os.environ, "TAG": "theirs"})
child.stdout.readline()
print(child.pid, flush=True)
sys.stdin.readline()
print(process_tree.end_descendants(os.getpid(), process_tree.reap_children), flush=True)
sys.stdin.readline()
"""


@pytest.fixture
def ancestor() -> Iterator[subprocess.Popen[str]]:
    """A process that has adopted its orphans, one child, and what that has started: two and a daemon."""
    process = subprocess.Popen(
        [sys.executable, "-c", ANCESTOR], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    yield process
    left = process_tree.descendants(process.pid)
    process.kill()
    process.communicate()
    for pid in left:
        process_tree.kill(pid, signal.SIGKILL)


def line(process: subprocess.Popen[str], told: str = "") -> str:
    """Tell a process something, if anything, and read its next line."""
    assert process.stdin is not None
    assert process.stdout is not None
    if told:
        process.stdin.write(f"{told}\n")
        process.stdin.flush()
    return process.stdout.readline().strip()


def test_all_of_a_family_end(ancestor: subprocess.Popen[str]) -> None:
    """Its children, theirs, those in sessions of their own, and daemons; and it says so."""
    child = int(line(ancestor))
    found = process_tree.descendants(ancestor.pid)
    assert len(found) == 4
    assert child in found
    assert set(process_tree.children(ancestor.pid)) < set(found)

    assert line(ancestor, "end them") == "True"
    assert not any(alive(pid) for pid in found)


@pytest.mark.parametrize("ends", [False, True])
def test_whether_a_process_has_started_any(ends: bool) -> None:
    """Children that live count, and those that were waited for."""
    program = (
        "import subprocess\n"
        "from graphflow.supervisor.processes.process_tree import has_started_any\n"
        "before = has_started_any()\n"
        "child = subprocess.Popen(['cat'], stdin=subprocess.PIPE)\n"
        f"if {ends}: child.communicate()\n"
        "print(before, has_started_any())\n"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert (run.stdout, run.stderr) == ("False True\n", "")


def test_what_tells_whose_a_process_is(ancestor: subprocess.Popen[str]) -> None:
    """The variables that it was started with, and the files that it has open; nothing of one that is gone."""
    child = int(line(ancestor))
    assert b"TAG=theirs" in process_tree.environment(child)
    with open(__file__) as file:
        assert os.path.realpath(file.name) in process_tree.files(os.getpid())
    assert process_tree.environment(2**22 + 1) == frozenset()
    assert process_tree.files(2**22 + 1) == set()


def test_the_name_of_a_process() -> None:
    """It is cut where the system's room for it ends, and so is its title; the environment stays as it is."""
    code = """
import sys
from graphflow.supervisor.processes import process_tree
process_tree.name_process("a_name_that_is_too_long", sys.argv[1])
for what in ("comm", "cmdline", "environ"):
    print(open(f"/proc/self/{what}").read().rstrip("\\n").replace(chr(0), "|"))
"""
    for title, shown in (("/arm/left", "graphflow: /arm/left"), ("x" * 1000, "graphflow: xxx")):
        command = [sys.executable, "-c", code, title]
        named = subprocess.run(command, capture_output=True, text=True, timeout=20, env={"COLOUR": "red"})
        comm, cmdline, environ, _ = named.stdout.split("\n")
        assert comm == "a_name_that_is_"
        assert cmdline.rstrip("|").startswith(shown)
        assert len(cmdline) == sum(len(word) + 1 for word in command)
        assert environ.startswith("COLOUR=red|")


def test_the_state_of_a_process(ancestor: subprocess.Popen[str]) -> None:
    """`T` while it is stopped, `Z` when it has ended and nobody has waited for it, none when it is gone."""
    child = int(line(ancestor))
    os.kill(child, signal.SIGSTOP)
    wait_for(child, "T")
    os.kill(child, signal.SIGKILL)
    wait_for(child, "Z")
    assert child not in process_tree.descendants(ancestor.pid)
    assert process_tree.state_of(2**22 + 1) == ""


def wait_for(pid: int, state: str) -> None:
    until(lambda: process_tree.state_of(pid) == state, state)


def test_children_that_have_ended() -> None:
    """Each is reported once, by its code or signal."""
    code = """
import os
from graphflow.supervisor.processes import process_tree
ends = {}
for end in (lambda: os._exit(3), os.abort):
    pid = os.fork()
    if pid == 0:
        end()
    ends[pid] = None
while None in ends.values():
    ends |= dict(process_tree.reaped())
process_tree.reap_children()
print(list(ends.values()), list(process_tree.reaped()))
"""
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=20)
    assert ended.stdout == "[3, -6] []\n"


@pytest.mark.parametrize("is_leader", [True, False])
def test_a_signal_reaches_a_group(is_leader: bool) -> None:
    """Or one process alone before it has made a group; what has ended needs none."""
    sleeper = subprocess.Popen(["sleep", "600"], start_new_session=is_leader)
    process_tree.kill_group(sleeper.pid, signal.SIGTERM)
    assert sleeper.wait(10.0) == -signal.SIGTERM
    process_tree.kill_group(sleeper.pid, signal.SIGKILL)
    process_tree.kill(sleeper.pid, signal.SIGKILL)


def test_what_belongs_to_another_user_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    """A child that `sudo` has started cannot be ended, and keeps nobody from ending the others."""
    tried: list[int] = []

    def refuse(pid: int, number: int) -> None:
        tried.append(pid)
        raise PermissionError

    monkeypatch.setattr(os, "kill", refuse)
    monkeypatch.setattr(os, "killpg", refuse)
    process_tree.kill(11, signal.SIGKILL)
    process_tree.kill_group(12, signal.SIGKILL)
    assert tried == [11, 12]
