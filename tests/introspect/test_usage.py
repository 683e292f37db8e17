"""CPU and memory of processes."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from graphflow.introspect.usage import Costs


def test_looks() -> None:
    """Live processes are measured with their nodes; others are left out and forgotten."""
    costs = Costs()
    [own] = costs.look({os.getpid(): ["/a", "/b"], 2**22 + 1: ["/gone"]})
    assert (own.pid, own.nodes) == (os.getpid(), ["/a", "/b"])
    assert own.memory > 1_000_000
    assert own.threads >= 1
    assert own.seconds > 0
    assert costs.look({}) == []
    assert not costs._known


@pytest.mark.real
def test_child_processes_count() -> None:
    """Child processes are included, unless they are measured themselves."""
    code = "import sys; held = bytearray(50_000_000); print(len(held), flush=True); sys.stdin.read()"
    with subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        child.stdout.readline()
        try:
            [together] = Costs().look({os.getpid(): ["/a"]})
            assert together.children >= 1
            both = {cost.pid: cost for cost in Costs().look({os.getpid(): ["/a"], child.pid: ["/b"]})}
            assert both[os.getpid()].children == together.children - 1
            assert both[child.pid].memory > 50_000_000
            assert together.memory > both[os.getpid()].memory + 40_000_000
        finally:
            child.communicate()


def test_order() -> None:
    """The dearest first, by processor or memory."""
    owners = {os.getpid(): ["/a"], os.getppid(): ["/b"]}
    for by_memory in (False, True):
        found = Costs().look(owners, by_memory=by_memory)
        key = [cost.memory if by_memory else cost.cpu for cost in found]
        assert key == sorted(key, reverse=True)
        assert len(found) == 2
