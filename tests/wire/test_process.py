"""The tokens of graphflow processes in a domain."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from graphflow.system import host_name, user_id
from graphflow.wire import process
from graphflow.wire.process import ProcessToken, answer_key, parse, token, watch_key

ELSEWHERE = ProcessToken("ab12", "1000", os.getpid(), "robot-7")
HERE = ELSEWHERE._replace(host=host_name())


def test_a_token_tells_of_its_process() -> None:
    """Session, user, process and host come back from it."""
    assert parse(token(3, "ab12")) == ProcessToken("ab12", str(user_id()), os.getpid(), host_name())


def test_keys() -> None:
    """Tokens and answers of a domain are apart from others', and from ROS 2's."""
    assert token(3, "ab12").startswith("@graphflow/3/proc/ab12/")
    assert watch_key(3) == "@graphflow/3/proc/**"
    assert answer_key(3, process.WAITS) == "@graphflow/3/waits/*"
    assert answer_key(3, process.LOOK, "ab12") == "@graphflow/3/look/ab12"


@pytest.mark.parametrize(
    "text",
    [
        "",
        "@graphflow/3/proc/ab12/1000/77",
        "@graphflow/3/proc/ab12/1000/77/host/more",
        "@graphflow/3/proc/ab12/1000/-7/host",
        "@graphflow/3/waits/ab12/1000/77/host",
        "@ros2_lv/3/proc/ab12/1000/77/host",
    ],
)
def test_what_is_no_token(text: str) -> None:
    """Other keys are nobody's."""
    assert parse(text) is None


def test_a_process_is_named_with_its_host_where_that_is_another() -> None:
    """Its number says enough on this machine, and nothing on another."""
    assert str(HERE) == f"process {os.getpid()}"
    assert str(ELSEWHERE) == f"process {os.getpid()} on robot-7"


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not tell")
def test_stopped_processes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those that have loaded Zenoh and use the same rendezvous and domain are listed, with their commands."""
    library = tmp_path / "libzenoh.so"
    library.write_bytes(bytes(4096))
    opened = f"f = open({os.fspath(library)!r}, 'r+b'); m = mmap.mmap(f.fileno(), 0)"
    code = f"import mmap, time; {opened}; print(); time.sleep(60)"
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", "tcp/127.0.0.1:1")
    command = [sys.executable, "-u", "-c", code]
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "7")
    others = {"GRAPHFLOW_RENDEZVOUS": "tcp/127.0.0.1:2"}, {"GRAPHFLOW_DOMAIN": "8"}
    environments = [os.environ.copy(), *(os.environ | other for other in others)]
    started = [subprocess.Popen(command, env=env, stdout=subprocess.PIPE) for env in environments]
    try:
        for one in started:
            assert one.stdout is not None
            one.stdout.readline()
        assert process.stopped(7) == {}
        for one in started:
            one.send_signal(signal.SIGSTOP)
            os.waitid(os.P_PID, one.pid, os.WSTOPPED)
        first = started[0].pid
        [(pid, text)] = process.stopped(7).items()
        assert (pid, text.startswith(f"process {first}, {sys.executable} -u -c ")) == (first, True)
        assert text.endswith(f", is stopped: kill -CONT {first}")
    finally:
        for one in started:
            one.kill()
            one.communicate()


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not tell")
def test_what_a_process_was_started_as() -> None:
    """This system tells of its own, and of those alone."""
    assert "pytest" in HERE.command or "python" in HERE.command
    assert ELSEWHERE.command == ""
    assert HERE._replace(pid=2**22 + 1).command == ""


@pytest.mark.parametrize("state", ["T", "t"])
def test_a_stopped_process_can_be_helped(monkeypatch: pytest.MonkeyPatch, state: str) -> None:
    """The advice tells how to continue it; of another machine's processes nothing is known."""
    monkeypatch.setattr(process, "_state", lambda pid: state)

    assert HERE.why_silent == f"it is stopped: kill -CONT {os.getpid()}"
    assert ELSEWHERE.why_silent.endswith("or it cannot be reached")


def test_a_process_that_runs_is_held_up() -> None:
    """One that is not stopped may be busy, or gone."""
    assert HERE.why_silent == "it is stopped, or something holds its interpreter, or it cannot be reached"
    assert HERE._replace(pid=2**22 + 1).why_silent == HERE.why_silent


@pytest.mark.parametrize("pid", ["9" * 5000, "٣", "-1", ""])
def test_pids_of_strangers(pid: str) -> None:
    """Are not converted."""
    assert process.parse(f"@graphflow/0/proc/abc/1000/{pid}/host") is None


def test_hosts_of_strangers() -> None:
    """Clear no screen."""
    assert process.parse("@graphflow/0/proc/abc/1000/5/ho\x1b[2Jst") is None
    assert process.parse("@graphflow/0/proc/abc/1000/5/" + "h" * 5000) is None
