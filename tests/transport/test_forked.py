"""Ports of a process in its forked children."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = """
import os, socket, sys
from graphflow.transport.forked import leave_port

with socket.create_server(("127.0.0.1", 0)) as ours, socket.create_server(("127.0.0.1", 0)) as others:
    port, other = ours.getsockname()[1], others.getsockname()[1]
    client = socket.create_connection(("127.0.0.1", port))
    accepted, _ = ours.accept()
    leave_port(port)
    done, begun = os.pipe()
    if os.fork() == 0:
        os.close(begun)
        os.read(done, 1)  # until the parent has looked
        os._exit(0)
    for held in (ours, accepted, others):
        held.close()
    is_gone = client.recv(1) == b""
    free = []
    for number in (port, other):
        try:
            socket.create_server(("127.0.0.1", number)).close()
            free.append(True)
        except OSError:
            free.append(False)
    print(is_gone, *free, flush=True)
    os.close(begun)
    os.wait()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not list a process's descriptors")
def test_what_a_child_keeps() -> None:
    """Neither the port nor its connections; the sockets of other ports are the program's own affair."""
    ended = subprocess.run([sys.executable, "-c", PROGRAM], check=True, timeout=30, capture_output=True, text=True)
    assert ended.stdout.split() == ["True", "True", "False"]
