"""A verb's side of the control socket; what passes between the two sides is in `test_control`."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from graphflow.errors import SupervisorError
from graphflow.supervisor.control.client import ControlClient


def test_nobody_answers(tmp_path: Path) -> None:
    """The error names the address."""
    with pytest.raises(SupervisorError, match=f"the supervisor at {tmp_path}/control.sock does not answer"):
        ControlClient(str(tmp_path / "control.sock"))


def test_on_loopback_the_token_is_shown() -> None:
    """With every request; the events end with the connection."""
    server = socket.create_server(("127.0.0.1", 0))
    asked: list[object] = []

    def serve() -> None:
        connection, _ = server.accept()
        with connection, connection.makefile("rb") as lines:
            asked.append(json.loads(lines.readline()))
            connection.sendall(b'{"event": "a"}\n{"event"')
            connection.sendall(b': "b"}\n')

    thread = threading.Thread(target=serve)
    thread.start()
    with ControlClient(f"tcp/{server.getsockname()[1]}/secret") as client:
        client.send(do="ps")
        assert [event["event"] for event in client.receive()] == ["a", "b"]
    thread.join(5.0)
    server.close()
    assert asked == [{"do": "ps", "token": "secret"}]


def test_it_needs_no_event_loop() -> None:
    """Importing asyncio would take as long as all else that `ps` does."""
    program = "import sys, graphflow.supervisor.control.client; print('asyncio' in sys.modules)"
    assert subprocess.check_output([sys.executable, "-c", program], text=True).strip() == "False"
