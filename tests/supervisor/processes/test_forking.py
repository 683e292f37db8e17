"""Workers forked from the preload process: what `test_starter` does not say of them."""

from __future__ import annotations

import asyncio
import os
import signal
import socket
import sys
from pathlib import Path
from typing import Any

import pytest

from graphflow.errors import SupervisorError
from graphflow.supervisor.processes import preload
from graphflow.supervisor.processes.forking import ForkingStarter
from graphflow.supervisor.processes.jobs import Start

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="nothing is forked there")


class Channel:
    """Stands for the socket to the preload process."""

    def __init__(self, *chunks: bytes) -> None:
        self.chunks = list(chunks)
        self.sent = b""

    def sendall(self, data: bytes) -> None:
        self.sent += data

    def recv(self, size: int) -> bytes:
        return self.chunks.pop(0) if self.chunks else b""


def starter(channel: Channel, monkeypatch: pytest.MonkeyPatch) -> ForkingStarter:
    def start(keep: tuple[int, ...]) -> tuple[Any, int, int]:
        assert keep == (5,)
        return channel, -1, 0

    monkeypatch.setattr(preload, "start", start)
    return ForkingStarter((5,))


def test_classes_are_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """By a line of JSON; the answer may come in pieces."""
    channel = Channel(b'{"event": "probed", "inter', b'faces": {"a:A": {}}}\n')
    made = starter(channel, monkeypatch)
    made.begin_probe(("a:A",), "/lab")
    assert channel.sent == b'{"do": "probe", "classes": ["a:A"], "root": "/lab"}\n'
    assert made.probed() == {"a:A": {}}


def killed() -> int:
    """A child that was killed, and that nobody has waited for."""
    pid = os.fork()
    if pid == 0:
        signal.pause()
    os.kill(pid, signal.SIGKILL)
    return pid


def test_a_preload_process_that_dies_meanwhile(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is told with its cause, whether it dies before it is asked or before it has answered."""
    mine, its = socket.socketpair()
    monkeypatch.setattr(preload, "start", lambda keep: (mine, -1, killed()))
    made = ForkingStarter(())
    its.close()
    made.begin_probe(("a:A",), "/lab")
    cause = r"process \d+, which starts the nodes, was ended by signal SIGKILL .* before the graph was up"
    with pytest.raises(SupervisorError, match=cause):
        made.probed()
    mine.close()

    channel = Channel(b'{"event"')
    monkeypatch.setattr(preload, "start", lambda keep: (channel, -1, killed()))
    with pytest.raises(SupervisorError, match=cause):
        ForkingStarter(()).probed()


def test_a_preload_process_that_fails_before_it_serves(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its traceback is shown, though it has no log yet."""

    def fail(_: object) -> None:
        raise MemoryError("no room for NumPy")

    monkeypatch.setattr(preload._Preload, "_warm_up", fail)
    made = ForkingStarter(())
    made.begin_probe(("a:A",), "/lab")
    with pytest.raises(SupervisorError, match=r"(?s)which starts the nodes, failed:\nTraceback.*no room for NumPy"):
        made.probed()
    made.end()
    os.close(made._status)


@pytest.mark.usefixtures("graphflow_runner")
async def test_what_a_worker_said_before_it_ended_is_heard_first(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Its words and its end come by two ways, and the loop may look at them in either order."""
    mine, preloads = socket.socketpair()
    status_read, status_write = os.pipe()
    monkeypatch.setattr(preload, "start", lambda keep: (mine, status_read, 0))
    heard: list[str] = []
    made = ForkingStarter(())
    await made.open(tmp_path / "log", lambda event: heard.append(event["event"]), lambda _: None)
    preloads.sendall(b'{"event": "spawned", "process": "/a", "pid": 4194305}\n')
    made._preload.read()
    os.write(status_write, b'{"event": "ready"}\n')
    preloads.sendall(b'{"event": "exited", "process": "/a", "pid": 4194305, "status": 0}\n')
    made._preload.read()
    assert heard == ["spawned", "ready", "exited"]
    await made.close()
    for end in (mine, preloads):
        end.close()
    for fd in (status_read, status_write):
        os.close(fd)


@pytest.mark.usefixtures("graphflow_runner")
async def test_a_worker_that_is_started_before_it_is_asked_for(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """It is started once; what becomes of it is told in order, once it is asked for. Later it is started anew."""
    mine, preloads = socket.socketpair()
    preloads.settimeout(5.0)
    status_read, status_write = os.pipe()
    monkeypatch.setattr(preload, "start", lambda keep: (mine, status_read, 0))
    heard: list[str] = []
    made = ForkingStarter(())
    job: Any = {"nodes": []}
    start = Start("/a", job, "a.log", {})
    made.begin([start])
    spawn = b'{"do": "spawn", "process": "/a", "job": {"nodes": []}, "log": "a.log", "env": {}}\n'
    assert preloads.recv(4096) == spawn

    await made.open(tmp_path / "log", lambda event: heard.append(event["event"]), lambda _: None)
    preloads.sendall(b'{"event": "spawned", "process": "/a", "pid": 4194305}\n')
    made._preload.read()
    os.write(status_write, b'{"event": "ready", "process": "/a"}\n')
    made._reports.read()
    assert heard == []
    made.spawn(*start)
    os.write(status_write, b'{"event": "beat", "process": "/a"}\n')
    made._reports.read()
    await asyncio.sleep(0)
    assert heard == ["spawned", "ready", "beat"]
    made.spawn(*start)
    assert preloads.recv(4096).splitlines(keepends=True)[1:] == [spawn]
    preloads.sendall(b'{"event": "exited", "process": "/a", "pid": 4194305, "status": 0}\n')
    made._preload.read()
    assert heard[3:] == ["exited"]
    await made.close()
    for end in (mine, preloads):
        end.close()
    for fd in (status_read, status_write):
        os.close(fd)
