"""The process that starts nodes."""

from __future__ import annotations

import os
import random
import signal
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from graphflow.supervisor.processes import preload
from graphflow.supervisor.processes.preload import (
    ORDER_BOUND,
    PROBE_LIMIT,
    _Preload,
    _reseed,
    _write_whole,
    probe_result,
    sweep,
)
from graphflow.system import is_portable
from tests.cases import slow
from tests.conftest import Machine, alive
from tests.supervisor.running import GOOD, nothing_is_left, rows, write


@slow
@pytest.mark.real
@pytest.mark.skipif(is_portable(), reason="the portable way has no preload process")
def test_the_preload_process_has_one_thread(machine: Machine, project: Path) -> None:
    """Otherwise forking it would be unsafe."""
    machine.run("up", "-d", write(project, GOOD), cwd=project)
    pid = rows(machine)["/a"]["pid"]
    preload = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1]
    assert len(list(Path(f"/proc/{preload}/task").iterdir())) == 1
    machine.look("down")


@slow
@pytest.mark.real
def test_fresh_interpreter_for_variables_that_need_one(machine: Machine, project: Path) -> None:
    """`env:` with PYTHON..., LD_... or MALLOC_... starts the node in an interpreter of its own."""
    text = "nodes:\n  /a: {class: nodes.lab:Good, env: {PYTHONHASHSEED: 7, COLOUR: blue}}\n"
    machine.run("up", "-d", write(project, text), cwd=project)
    pid = rows(machine)["/a"]["pid"]
    assert b"PYTHONHASHSEED=7" in Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
    assert Path(f"/proc/{pid}/cmdline").read_bytes().rstrip(b"\0") == b"graphflow: /a"
    assert "blue" in machine.look("service", "call", "/a/ask", "std_srvs/srv/Trigger")
    machine.look("down")
    nothing_is_left(machine, [pid])


@slow
@pytest.mark.real
def test_an_impossible_environment_fails_its_node_only(machine: Machine, project: Path) -> None:
    """The process that starts nodes survives what cannot be started."""
    text = 'nodes:\n  /bad: {class: nodes.lab:Good, env: {"LD_A=B": x}}\n'
    up = machine.start("up", write(project, text), cwd=project)
    assert up.wait() == 1
    assert "cannot be started" in up.text


@slow
@pytest.mark.real
@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGKILL])
def test_what_a_node_has_started_goes_with_it(machine: Machine, project: Path, how: int) -> None:
    """A child process of a node does not outlive it, however the node ends."""
    up = machine.start("up", write(project, "nodes:\n  /p: {class: nodes.lab:Parent}\n"), cwd=project)
    machine.until(lambda: "child " in machine.look("logs", "/p", code=None), "it has a child")
    machine.look("wait")
    child = int(machine.look("logs", "/p").split("child ")[1].split(".")[0])
    assert alive(child)

    os.kill(rows(machine)["/p"]["pid"], how)

    machine.until(lambda: not alive(child), "the child is gone")
    up.wait()


def test_what_a_probing_child_wrote() -> None:
    """Its answer, or one problem for each class: that it took too long, or what ended it, even within its answer."""
    assert probe_result(b'{"a:A": {"doc": ""}}', True, ["a:A"], 0) == {"a:A": {"doc": ""}}
    ended = {"problem": "the process that imported it was ended by exit code 0"}
    assert probe_result(b"", True, ["a:A", "b:B"], 0) == {"a:A": ended, "b:B": ended}
    killed = probe_result(b'{"a', True, ["a:A"], -signal.SIGKILL)["a:A"]["problem"]
    assert str(killed).startswith("the process that imported it was ended by signal SIGKILL")
    late = probe_result(b'{"a', False, ["a:A"], -signal.SIGKILL)["a:A"]["problem"]
    assert str(late).startswith(f"importing it takes longer than {PROBE_LIMIT:.0f} s; ")


@pytest.mark.real
@pytest.mark.skipif(sys.platform == "win32", reason="there are no process groups")
def test_what_a_worker_has_left_behind() -> None:
    """Its process group is ended; one that has ended already is none."""
    sleeper = subprocess.Popen(["sleep", "600"], start_new_session=True)
    sweep(sleeper.pid)
    assert sleeper.wait(10.0) == -signal.SIGKILL
    sweep(sleeper.pid)


def test_workers_have_random_numbers_of_their_own() -> None:
    """Two that are forked from one process do not draw the same."""
    drawn = []
    for _ in range(2):
        random.seed(1)
        np.random.seed(1)
        _reseed()
        drawn.append((random.random(), float(np.random.random())))
    assert drawn[0][0] != drawn[1][0]
    assert drawn[0][1] != drawn[1][1]


@pytest.mark.skipif(is_portable(), reason="the portable way has no preload process")
def test_an_order_goes_into_a_pipe_whole_or_not_at_all() -> None:
    """The preload process never waits for a worker that does not read."""
    read, write = os.pipe()
    os.set_blocking(write, False)
    line = b"x" * (ORDER_BOUND - 1) + b"\n"
    assert _write_whole(write, line)
    assert not _write_whole(write, b"more\n")
    assert os.read(read, 2 * len(line)) == line
    os.close(read)
    assert not _write_whole(write, b"nobody reads\n")
    os.close(write)


@pytest.mark.skipif(is_portable(), reason="the portable way has no preload process")
def test_a_supervisor_that_is_killed_before_it_has_read_all(monkeypatch: pytest.MonkeyPatch) -> None:
    """The workers are ended as after any other end of it, whichever call finds out."""

    def end(_: object) -> None:
        raise SystemExit

    monkeypatch.setattr(_Preload, "_end", end)
    for find_out in (_Preload._receive, lambda made: made._answer({"event": "spawned"})):
        mine, its = socket.socketpair()
        its.sendall(b"an answer that nobody reads\n")
        mine.close()
        with pytest.raises(SystemExit):
            find_out(_Preload(its, -1))
        its.close()


@pytest.mark.skipif(is_portable(), reason="the portable way has no preload process")
def test_an_order_that_a_pipe_does_not_take() -> None:
    """It is refused with its size."""
    read, write = os.pipe()
    order: Any = {"order": 1, "text": "x" * ORDER_BOUND}
    assert preload._write_order(write, order).endswith(f"bytes long, and a process takes {ORDER_BOUND}")
    order["text"] = "x"
    assert preload._write_order(write, order) == ""
    os.close(read)
    os.close(write)
