"""Ports of a process in its forked children."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = """
import os, socket, stat, sys
from graphflow.transport.forked import leave_port

def opened():
    return len(os.listdir("/proc/self/fd"))

local = socket.socketpair()
servers = [socket.create_server(("127.0.0.1", 0)) for _ in range(3)]
ours, second, others = servers
ports = [server.getsockname()[1] for server in servers]
client = socket.create_connection(("127.0.0.1", ports[0]))
client.settimeout(10.0)
accepted, _ = ours.accept()
for port in ports[:2]:
    leave_port(port)
done, begun = os.pipe()
told, says = os.pipe()
before = opened()
if os.fork() == 0:
    after = opened()
    os.close(begun)
    idle = [stat.S_ISCHR(os.fstat(held.fileno()).st_mode) for held in (ours, accepted, second, others, *local)]
    os.write(says, f"{after - before} {idle}".encode())
    os.read(done, 1)  # until the parent has looked
    os._exit(0)
os.close(says)
for held in (ours, accepted, second, others):
    held.close()
is_gone = client.recv(1) == b""
free = []
for number in ports:
    try:
        socket.create_server(("127.0.0.1", number)).close()
        free.append(True)
    except OSError:
        free.append(False)
print(is_gone, free)
print(os.read(told, 1000).decode(), flush=True)
os.close(begun)
os.wait()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not list a process's descriptors")
def test_what_a_child_keeps() -> None:
    """Neither the ports nor their connections; sockets of other ports, and those without, are the program's own affair.

    The descriptors are still taken, and no others are.
    """
    ended = subprocess.run([sys.executable, "-c", PROGRAM], check=True, timeout=30, capture_output=True, text=True)
    parent, child = ended.stdout.splitlines()
    assert parent == "True [True, True, False]"
    assert child == "0 [True, True, True, False, False, False]"
