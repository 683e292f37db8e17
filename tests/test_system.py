"""Which of an operating system's ways are taken."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
from pathlib import Path

import pytest

from graphflow.errors import UsageFault
from graphflow.system import (
    ROS2,
    chosen_loop,
    collect_normally,
    collect_rarely,
    detached,
    host_name,
    is_portable,
    offer_ros2,
)
from tests.until import until


@pytest.mark.parametrize(
    ("platform", "value", "portable"),
    [
        ("linux", "", False),
        ("linux", "0", False),
        ("linux", "1", True),
        ("darwin", "", True),
        ("darwin", "0", True),
        ("win32", "", True),
    ],
)
def test_which_ways(platform: str, value: str, portable: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Linux takes its own unless it is told otherwise; the others have no choice."""
    monkeypatch.setattr(sys, "platform", platform)
    monkeypatch.setenv("GRAPHFLOW_PORTABLE", value)
    assert is_portable() is portable
    assert list(detached()) == (["creationflags"] if platform == "win32" else ["start_new_session"])


def test_a_program_ros2(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is offered once, and after one that there is."""
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("GRAPHFLOW_PYTHON", raising=False)
    offer_ros2()
    offer_ros2()
    assert os.environ["PATH"] == f"{tmp_path}{os.pathsep}{ROS2}"
    assert os.environ["GRAPHFLOW_PYTHON"] == sys.executable
    (tmp_path / "ros2").touch(mode=0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    offer_ros2()
    assert os.environ["PATH"] == str(tmp_path)


def test_a_host_name_fits_into_a_key(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever a machine is called, its name is one part of a key expression."""
    monkeypatch.setattr("platform.node", lambda: "Ann's robot #1/*")
    assert host_name() == "Ann_s_robot__1__"


@pytest.mark.real
@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells of a parent's end")
@pytest.mark.parametrize("is_alive", [True, False])
def test_a_process_that_ends_with_its_parent(tmp_path: Path, is_alive: bool) -> None:
    """Asked to by the system; if the parent has ended already, at once."""
    code = f"""
import os, signal, sys, time
from graphflow.system import end_with_parent
parent = os.getpid()
read, write = os.pipe()
pid = os.fork()
if pid == 0:
    def end(*_):
        open({str(tmp_path / "asked")!r}, "w").close()
        os._exit(0)
    signal.signal(signal.SIGTERM, end)
    end_with_parent(parent if {is_alive} else -1, signal.SIGTERM)
    os.write(write, b"-")
    time.sleep(600)
if {is_alive}:
    os.read(read, 1)
    os._exit(0)
os._exit(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]))
"""
    assert subprocess.run([sys.executable, "-c", code], timeout=20).returncode == 0
    until((tmp_path / "asked").exists)


def test_the_collector_runs_rarely_only_for_a_while() -> None:
    """Nodes run with the thresholds that the process began with."""
    usual = gc.get_threshold()
    try:
        collect_rarely()
        assert gc.get_threshold()[0] > 10 * usual[0]
    finally:
        collect_normally()
    assert gc.get_threshold() == usual


def test_a_loop_that_there_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is refused with the choices; none is chosen by default."""
    monkeypatch.delenv("GRAPHFLOW_LOOP", raising=False)
    assert chosen_loop() == ""
    monkeypatch.setenv("GRAPHFLOW_LOOP", "trio")
    with pytest.raises(UsageFault, match="GRAPHFLOW_LOOP is 'trio'; it may be 'asyncio' or 'uvloop'"):
        chosen_loop()


def test_a_loop_that_is_not_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The error has the command that installs it."""
    monkeypatch.setenv("GRAPHFLOW_LOOP", "uvloop")
    monkeypatch.setitem(sys.modules, "uvloop", None)
    with pytest.raises(UsageFault, match="'uvloop', which is not installed: pip install uvloop"):
        chosen_loop()
