"""`graphflow view`."""

from __future__ import annotations

import asyncio
import re
import signal
import socket
from importlib.machinery import ModuleSpec

import pytest

from graphflow.cli.graphs import view as module
from graphflow.cli.graphs.view import _is_loopback, _url_host
from graphflow.introspect.installation import requirement
from tests.cases import slow
from tests.conftest import Machine
from tests.viewer.cast import viewer


def test_addresses() -> None:
    """Viewers beyond this machine only look."""
    assert all(map(_is_loopback, ("127.0.0.1", "127.0.0.2", "::1", "localhost")))
    assert not any(map(_is_loopback, ("0.0.0.0", "::", "192.168.1.5", "example.org")))


def test_addresses_that_viewers_can_open() -> None:
    """IPv6 in brackets, and for all addresses the name of this machine."""
    assert [_url_host(host) for host in ("127.0.0.1", "::1", "0.0.0.0", "localhost")] == [
        *("127.0.0.1", "[::1]"),
        *(socket.gethostname(), "localhost"),
    ]


@slow
@pytest.mark.real
def test_a_graph_that_runs(standing: Machine) -> None:
    """Its topics are there; Ctrl-C ends it."""
    program = standing.start("view", "--port", "0")
    port = int(re.findall(r"Serving viewers on ws://127.0.0.1:(\d+)\n", program.wait_for("Ctrl-C ends it"))[0])

    async def look() -> None:
        async with viewer(port) as seen:
            await seen.subscribe(1, "/chatter")
            await seen.until(lambda: seen.messages)

    asyncio.run(look())
    assert program.end(signal.SIGINT) == 0, program.text


@slow
@pytest.mark.real
def test_what_cannot_be_served(standing: Machine) -> None:
    """A port that is taken, an address that is not here."""
    with socket.create_server(("127.0.0.1", 0)) as taken:
        text = standing.run("view", "--port", str(taken.getsockname()[1]), code=1)
    assert "the port is taken; take another --port" in text
    for host in ("192.0.2.1", "no-such-host.invalid", "x" * 70):
        text = standing.run("view", "--host", host, code=1)
        assert "--host is an address of this machine" in text
        assert "Traceback" not in text


def test_without_the_extra(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    """The error has the command that installs the extra."""

    def missing(_: str) -> ModuleSpec | None:
        return None

    monkeypatch.setattr(module, "find_spec", missing)
    assert f"pip install {requirement('view')}" in machine.look("view", code=2)
