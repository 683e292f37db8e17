"""The files of a running graph, and finding the graph by them."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import asdict, replace
from pathlib import Path

import pytest

from graphflow.errors import SupervisorError
from graphflow.folders import log_root
from graphflow.supervisor import rundir
from graphflow.supervisor.rundir import (
    SOCKET_PATH_LIMIT,
    GraphRun,
    RunDirectory,
    log_file,
    new_run_id,
    open_logs,
    read_run,
    running,
    runtime_root,
    start_time,
)
from graphflow.system import is_portable


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Run and state directories of the test's own."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path / "run"))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.delenv("ROS_LOG_DIR", raising=False)
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "7")
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", "tcp/x")
    return tmp_path


def a_run(graph: str = "chase", domain: int = 7) -> GraphRun:
    """A run file of this very process."""
    started = start_time(os.getpid())
    assert started is not None
    return GraphRun("id", graph, domain, os.getpid(), started, 1_700_000_000.0, "/g.yaml", "/s", "/l", "tcp/x", "hash")


def start(graph: str = "chase", domain: int = 7) -> RunDirectory:
    directory = RunDirectory(domain, graph)
    directory.claim()
    directory.write(a_run(graph, domain))
    return directory


def test_folders_of_runs_are_private(folders: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They lie under XDG_RUNTIME_DIR, else under the temporary directory, and are for the user's eyes only."""
    assert runtime_root() == folders / "run/graphflow"
    assert runtime_root().stat().st_mode & 0o777 == 0o700
    monkeypatch.delenv("XDG_RUNTIME_DIR")
    monkeypatch.setattr(tempfile, "tempdir", str(folders))
    assert runtime_root() == folders / f"graphflow-{os.getuid()}"
    assert runtime_root().stat().st_mode & 0o777 == 0o700


def test_a_folder_that_cannot_be_made(folders: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The error names the obstacle, and the variable that avoids it."""
    (folders / "file").touch()
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(folders / "file"))
    with pytest.raises(SupervisorError, match="Not a directory; set XDG_RUNTIME_DIR to a folder you can write to"):
        runtime_root()
    monkeypatch.setenv("ROS_LOG_DIR", str(folders / "file"))
    with pytest.raises(SupervisorError, match="Not a directory; set ROS_LOG_DIR to a folder you can write to"):
        open_logs("chase", "id")


def test_a_folder_of_somebody_else_is_not_used(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nobody else can lay a folder in wait."""
    runtime_root()
    monkeypatch.setattr(os, "getuid", lambda: 12345678)
    with pytest.raises(SupervisorError, match="belongs to another user; set XDG_RUNTIME_DIR to a folder of your own"):
        runtime_root()


def test_where_logs_go(folders: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """ROS_LOG_DIR comes before XDG_STATE_HOME, which comes before the home's own folder."""
    assert log_root() == folders / "state/graphflow"
    monkeypatch.delenv("XDG_STATE_HOME")
    monkeypatch.setenv("HOME", str(folders / "home"))
    assert log_root() == folders / "home/.local/state/graphflow"
    monkeypatch.setenv("ROS_LOG_DIR", str(folders / "ros"))
    assert log_root() == folders / "ros"


@pytest.mark.skipif(is_portable(), reason="the portable way has no link")
def test_latest_points_to_the_newest_logs(folders: Path) -> None:
    """Each run has a folder of its own, and the link moves on."""
    first = open_logs("chase", "1")
    assert (folders / "state/graphflow/chase/latest").resolve() == first
    second = open_logs("chase", "2")
    assert (folders / "state/graphflow/chase/latest").resolve() == second
    assert sorted(p.name for p in first.parent.iterdir()) == ["1", "2", "latest"]


def test_names_of_logs_and_runs() -> None:
    """A node's log is called as the node, with dots; a run's id sorts by time and tells its process."""
    assert log_file(Path("/l"), "/turtle1/follower") == Path("/l/turtle1.follower.log")
    assert log_file(Path("/l"), "/talker") == Path("/l/talker.log")
    assert new_run_id().endswith(f"-{os.getpid()}")


def test_start_times_tell_processes_apart() -> None:
    """A living process has one that does not change; a dead one, reaped or not, has none."""
    mine = start_time(os.getpid())
    assert mine is not None
    assert start_time(os.getpid()) == mine
    child = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE, stderr=subprocess.DEVNULL)
    assert start_time(child.pid) is not None
    assert child.stdin is not None
    child.stdin.close()
    os.waitid(os.P_PID, child.pid, os.WEXITED | os.WNOWAIT)
    assert start_time(child.pid) is None
    child.wait()
    assert start_time(child.pid) is None


def test_a_graph_is_found_while_it_runs() -> None:
    """From the writing of its run file to its release."""
    assert running() == []
    directory = RunDirectory(7, "chase")
    directory.claim()
    assert running() == []
    directory.write(a_run())
    assert running() == [a_run()]
    directory.release()
    assert running() == []


def test_release_leaves_nothing() -> None:
    """Run file, socket and empty folders go; releasing twice does no harm; folders in use and locks stay."""
    one, two = start("one"), start("two")
    (one.path / "control.sock").touch()
    one.release()
    assert sorted(p.name for p in runtime_root().rglob("*")) == [*("7", "7.one.lock", "7.two.lock", "run.json", "two")]
    one.release()
    two.release()
    assert sorted(p.name for p in runtime_root().iterdir()) == ["7.one.lock", "7.two.lock"]


def test_a_graph_runs_once() -> None:
    """A second claim is refused with the process and the way to stop it, until the first is released."""
    first = start()
    second = RunDirectory(7, "chase")
    with pytest.raises(SupervisorError) as caught:
        second.claim()
    text = str(caught.value)
    assert text.startswith("graph chase is already running (domain 7 since ")
    assert text.endswith(f", process {os.getpid()}); stop it with: graphflow down --graph chase")
    start("chase", domain=8).release()
    first.release()
    second.claim()
    second.release()


def test_a_claim_before_the_run_file() -> None:
    """While the first is still coming up, there is less to tell."""
    first = RunDirectory(7, "chase")
    first.claim()
    with pytest.raises(SupervisorError, match=r"graph chase is already running \(domain 7\); stop it with"):
        RunDirectory(7, "chase").claim()
    first.release()


def test_a_claim_where_nothing_can_be_written(folders: Path) -> None:
    """The error names the obstacle."""
    runtime_root()
    (folders / "run/graphflow/7").touch()
    with pytest.raises(SupervisorError, match="7/chase: Not a directory"):
        RunDirectory(7, "chase").claim()


def test_a_killed_supervisor_leaves_no_running_graph() -> None:
    """A run file whose process is gone, or whose number now belongs to another, counts for nothing."""
    directory = start()
    directory.write(replace(a_run(), started=1.0))
    assert running() == []
    directory.write(replace(a_run(), pid=2**22 + 1))
    assert running() == []
    directory.release()


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", '{"graph": "x"}', "null", "\x00"])
def test_what_is_no_run_file_is_none(text: str) -> None:
    """Half-written or foreign files are passed over."""
    directory = start()
    file = directory.path / "run.json"
    file.write_text(text)
    assert read_run(file) is None
    assert running() == []
    file.unlink()
    assert read_run(file) is None
    directory.release()


def test_a_run_file_is_whole() -> None:
    """It holds what was written, and no draft is left beside it."""
    directory = start()
    assert json.loads((directory.path / "run.json").read_text()) == asdict(a_run())
    assert read_run(directory.path / "run.json") == a_run()
    assert sorted(p.name for p in directory.path.iterdir()) == ["run.json"]
    directory.release()


def test_a_socket_in_a_long_path_goes_elsewhere(folders: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A Unix socket's path is limited, so a long one has a stand-in, the same each time."""
    monkeypatch.setattr(tempfile, "tempdir", "/tmp")
    short = RunDirectory(7, "a")
    if len(os.fsencode(short.path / "control.sock")) <= SOCKET_PATH_LIMIT:
        assert short.socket == short.path / "control.sock"
    long = RunDirectory(7, "a" * SOCKET_PATH_LIMIT)
    assert long.socket.parent == Path(f"/tmp/graphflow-{os.getuid()}")
    assert len(os.fsencode(long.socket)) <= SOCKET_PATH_LIMIT
    assert long.socket == RunDirectory(7, "a" * SOCKET_PATH_LIMIT).socket
    assert long.socket != RunDirectory(8, "a" * SOCKET_PATH_LIMIT).socket


def test_without_proc_psutil_tells(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without /proc, the time comes from psutil, under the same rules."""
    monkeypatch.setattr(rundir, "Path", lambda path: Path("/nowhere" + path))
    assert start_time(os.getpid()) is not None
    assert start_time(2**22 + 1) is None


@pytest.mark.parametrize("variable", ["XDG_RUNTIME_DIR", "XDG_STATE_HOME"])
def test_a_relative_folder_counts_as_none(variable: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """It would be another one for each verb that is typed elsewhere."""
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv(variable, "here")
    monkeypatch.chdir(tmp_path)
    assert runtime_root().is_absolute()
    assert log_root().is_absolute()
    monkeypatch.setenv("ROS_LOG_DIR", "logs")
    assert log_root() == tmp_path / "logs"


def test_no_node_writes_into_the_log_of_the_supervisor() -> None:
    """Whatever it is called."""
    assert log_file(Path("/l"), "/supervisor").name != rundir.SUPERVISOR_LOG
    assert not rundir.SUPERVISOR_LOG.removesuffix(".log").replace(".", "_").isidentifier()


def test_names_are_claimed_by_one_graph_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a domain and a rendezvous; whoever has ended or died claims nothing."""
    first, second = start("first"), start("second")
    first.claim_names(["/a", "/b"])
    first.claim_names(["/a", "/b"])
    with pytest.raises(SupervisorError, match=r"already in domain 7: /b \(graph first\)"):
        second.claim_names(["/b", "/c"])
    second.claim_names(["/c"])
    elsewhere = start("third", domain=8)
    elsewhere.claim_names(["/a"])
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", "tcp/y")
    second.claim_names(["/a"])
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", "tcp/x")
    assert first._lock is not None
    os.close(first._lock)  # as when its process dies
    first._lock = None
    second.claim_names(["/a", "/b"])
    for directory in (first, second, elsewhere):
        directory.release()


def test_another_graph_that_claims_names_is_waited_for_but_not_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    """It takes a moment, unless it is stopped meanwhile."""
    monkeypatch.setattr(rundir, "NAMES_PATIENCE", 0.05)
    directory = start()
    with (runtime_root() / "names.lock").open("w") as held:
        rundir.lock_file(held.fileno())
        with pytest.raises(SupervisorError, match=r"names.lock has been locked for 0.05 s"):
            directory.claim_names(["/a"])
    directory.claim_names(["/a"])
    directory.release()


def test_a_directory_that_is_taken_away_is_made_again(folders: Path) -> None:
    """And nobody else can claim it."""
    directory = start()
    assert directory.is_there(a_run())
    shutil.rmtree(folders / "run")
    assert not directory.is_there(a_run())
    directory.restore()
    directory.write(a_run())
    assert directory.is_there(a_run())
    with pytest.raises(SupervisorError, match="already running"):
        RunDirectory(7, "chase").claim()
    shutil.rmtree(folders / "run")
    (folders / "run").touch()
    with pytest.raises(SupervisorError, match=f"{folders / 'run'}"):
        directory.restore()
