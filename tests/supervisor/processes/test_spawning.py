"""Workers as interpreters of their own: what `test_starter` does not say of them."""

from __future__ import annotations

import asyncio
import json
import os
from pathlib import Path
from typing import Any

import pytest

from graphflow.supervisor.processes.spawning import SpawningStarter

pytestmark = [pytest.mark.real, pytest.mark.usefixtures("graphflow_runner")]


async def opened(tmp_path: Path) -> tuple[SpawningStarter, list[Any], int]:
    """A starter, what it hears, and its port."""
    starter, heard = SpawningStarter(), list[Any]()
    await starter.open(tmp_path / "supervisor.log", heard.append, lambda _: None)
    assert starter._server is not None
    return starter, heard, starter._server.sockets[0].getsockname()[1]


async def say(port: int, *lines: bytes) -> bytes:
    """Return the answer to a stranger on the machine, until the connection is closed."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.writelines(lines)
    writer.write_eof()
    said = await reader.read()
    writer.close()
    await writer.wait_closed()
    return said


@pytest.mark.parametrize(
    "hello", [b"", b"nonsense\n", b"{}\n", b"[]\n", b'{"token": "0", "process": "/a"}\n', b'{"token": null}\n']
)
async def test_without_the_token_nobody_is_heard(tmp_path: Path, hello: bytes) -> None:
    """A process that finds the port cannot pose as a worker; its connection is closed without an answer."""
    starter, heard, port = await opened(tmp_path)
    assert await say(port, hello, b'{"event": "ready", "process": "/a", "node": "/a"}\n') == b""
    assert heard == []
    await starter.close()


async def test_a_worker_that_shows_it_is_heard(tmp_path: Path) -> None:
    """Its events arrive unchanged, until one is not JSON."""
    starter, heard, port = await opened(tmp_path)
    starter._disconnected["/a"] = asyncio.Event()
    hello = json.dumps({"token": starter._token, "process": "/a"}).encode() + b"\n"
    await say(port, hello, b'{"event": "ready"}\n', b"nonsense\n", b'{"event": "late"}\n')
    assert heard == [{"event": "ready"}]
    assert starter._disconnected["/a"].is_set()
    assert starter._connections == {}
    await starter.close()


async def test_ending_what_has_ended(tmp_path: Path) -> None:
    """A process that is gone needs no end."""
    starter, heard, _ = await opened(tmp_path)
    gone = await asyncio.create_subprocess_exec("true")
    await gone.wait()
    starter.terminate("/a", gone.pid)
    starter.kill("/a", gone.pid)
    await starter.close()
    starter.end()
    assert heard == []


async def test_closing_ends_its_workers(tmp_path: Path) -> None:
    """Also one that has not yet connected."""
    starter, heard, _ = await opened(tmp_path)
    job: Any = {"process": "/a", "file": "lab.yaml", "root": str(tmp_path), "nodes": []}
    starter.spawn("/a", job, str(tmp_path / "a.log"), {})
    while not heard:
        await asyncio.sleep(0)
    await starter.close()
    assert [event["event"] for event in heard] == ["spawned", "exited"]
    assert heard[1]["status"] < 0 or os.name == "nt"
