"""The connection to the supervisor, over a real socket."""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from graphflow.graph.plan import Plan
from graphflow.supervisor.control.clients import Clients
from graphflow.supervisor.control.server import ControlServer
from graphflow.supervisor.rundir import GraphRun
from graphflow.tui.feeds import supervision as module
from graphflow.tui.feeds.supervision import NodeRow, Supervision
from tests.until import eventually

pytestmark = pytest.mark.usefixtures("graphflow_runner")


class Graph:
    """A supervisor that records its requests."""

    plan = Plan("g", "g.yaml", "/", ())
    components: Any = None

    def __init__(self) -> None:
        self.asked: list[str] = []
        self.clients = Clients(lambda: self.asked.append("empty"))

    def hello(self) -> Any:
        return {"event": "hello", "version": "0.0.0", "layout": self.clients.layout}

    def describe(self) -> Any:
        return [{"node": "/a", "state": "ready"}]

    def begin_stop(self, *, now: bool, reason: str) -> None:
        self.asked.append(f"stop {reason}")

    def restart(self, node: str, by: str, *, only_ended: bool = False, threads: Sequence[str] = ()) -> None:
        self.asked.append(f"restart {node}")
        self.clients.announce(f"restart {node}", by)

    def stop(self, node: str, by: str) -> None:
        self.asked.append(f"stop {node}")


def run_at(address: str) -> GraphRun:
    return GraphRun("id", "g", 0, 1, 0.0, time.time(), "g.yaml", address, "", "", "")


async def test_the_end_is_heard_by_who_was_asleep(tmp_path: Path) -> None:
    """The supervisor's last events are read even when requests can no longer be sent."""
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(str(tmp_path / "s"))
        server.listen()
        heard: list[dict[str, Any]] = []
        one = Supervision(run_at(str(tmp_path / "s")), heard.append)
        task = asyncio.ensure_future(one.follow())
        await eventually(lambda: one.is_connected)
        connection, _ = server.accept()
        connection.sendall(b'{"event": "exited", "unexpected": false}\n{"event": "end", "exit_code": 3}\n')
        connection.close()
        assert one.send(do="ps")
        assert not one.send(do="ps")
        await asyncio.wait_for(task, 5.0)
    assert one.exit_code == 3
    assert [event["event"] for event in heard] == ["exited", "end", "lost"]


async def test_nobody_there(tmp_path: Path) -> None:
    """A missing supervisor is reported."""
    heard: list[dict[str, Any]] = []
    await Supervision(run_at(str(tmp_path / "s")), heard.append).follow()
    assert "the connection to the supervisor is lost: " in heard[0]["message"]


@pytest.mark.parametrize(
    ("last", "state", "detail"),
    [(b"", "lost", "the supervisor has gone"), (b'{"event": "end", "exit_code": 0}\n', "ended", "")],
)
async def test_nodes_of_a_supervisor_that_has_gone(tmp_path: Path, last: bytes, state: str, detail: str) -> None:
    """No node counts as running any more; one that had failed still has."""
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(str(tmp_path / "s"))
        server.listen()
        one = Supervision(run_at(str(tmp_path / "s")), lambda _: None)
        row = NodeRow(
            {
                "node": "/a",
                "state": "ready",
                "lifecycle": "",
                "pid": 7,
                "since": 0.0,
                "process": "",
                "class": "",
                "log": "",
                "restarts": 0,
                "detail": "",
            }
        )
        one.nodes = {
            "/a": row,
            "/b": {**row, "node": "/b", "state": "failed", "pid": 8, "detail": "signal SIGSEGV"},
        }
        task = asyncio.ensure_future(one.follow())
        await eventually(lambda: one.is_connected)
        connection, _ = server.accept()
        connection.sendall(last)
        connection.shutdown(socket.SHUT_WR)
        await asyncio.wait_for(task, 5.0)
        connection.close()
    ends = {name: (row["state"], row["pid"], row["detail"]) for name, row in one.nodes.items()}
    assert ends == {"/a": (state, None, detail), "/b": ("failed", 8, "signal SIGSEGV")}


@pytest.mark.parametrize("portable", ["", "1"])
async def test_two_consoles(portable: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each console sees the actions of the other; the saved windows of one are found by the next; leaving is seen."""
    monkeypatch.setenv("GRAPHFLOW_PORTABLE", portable)
    graph = Graph()
    server = ControlServer(graph)
    run = run_at(await server.open(tmp_path / "c.sock"))
    heard: list[dict[str, Any]] = []
    one, two = Supervision(run, heard.append), Supervision(run, lambda _: None)
    two.name = "pts/2"
    tasks = [asyncio.ensure_future(x.follow()) for x in (one, two)]
    await eventually(lambda: len(one.consoles) == 2 and bool(two.nodes) and one.plan is not None)
    assert one.hello["version"] == "0.0.0"
    assert "0.0.0" in one.version_note
    two.send(do="restart", node="/a")
    await eventually(lambda: any(e["event"] == "announced" for e in heard))
    [told] = [e for e in heard if e["event"] == "announced"]
    assert (told["text"], told["by"]) == ("restart /a", "pts/2")
    two.send(do="keep_layout", layout={"windows": []})
    await eventually(lambda: graph.clients.layout == {"windows": []})
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
    await eventually(lambda: graph.asked == ["restart /a", "empty"])
    await server.close()


@pytest.mark.parametrize("portable", ["", "1"])
async def test_what_was_asked_last_is_done(portable: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Leaving waits until the supervisor has read all requests, and does not count as the supervisor's end."""
    monkeypatch.setenv("GRAPHFLOW_PORTABLE", portable)
    graph = Graph()
    server = ControlServer(graph)
    heard: list[dict[str, Any]] = []
    one = Supervision(run_at(await server.open(tmp_path / "c.sock")), heard.append)
    task = asyncio.ensure_future(one.follow())
    await eventually(lambda: bool(one.nodes))
    for i in range(100):
        graph.clients.broadcast({"event": "note", "text": str(i)})
        one.send(do="keep_layout", layout={"windows": [i]})
    await one.leave()
    assert graph.clients.layout == {"windows": [99]}
    assert not one.send(do="ps")
    await asyncio.wait_for(task, 5.0)
    assert "lost" not in [event["event"] for event in heard]
    await server.close()


async def test_leaving_a_supervisor_that_does_not_listen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Leaving takes no longer than its limit."""
    monkeypatch.setattr(module, "LEAVE_WITHIN", 0.05)
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(str(tmp_path / "s"))
        server.listen()
        one = Supervision(run_at(str(tmp_path / "s")), lambda _: None)
        await one.leave()
        task = asyncio.ensure_future(one.follow())
        await eventually(lambda: one.is_connected)
        await one.leave()
    await asyncio.wait_for(task, 5.0)


async def test_a_supervisor_that_goes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The end is reported, and nothing can be sent any more."""
    monkeypatch.setattr(module, "POLL_INTERVAL", 0.01)
    graph = Graph()
    server = ControlServer(graph)
    heard: list[dict[str, Any]] = []
    one = Supervision(run_at(await server.open(tmp_path / "c.sock")), heard.append)
    task = asyncio.ensure_future(one.follow())
    await eventually(lambda: bool(one.nodes))
    graph.clients.broadcast({"event": "end", "exit_code": 3})
    await server.close()
    await asyncio.wait_for(task, 5.0)
    assert one.exit_code == 3
    assert heard[-1]["event"] == "lost"
    assert not one.send(do="ps")
