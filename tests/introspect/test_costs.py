"""What processes cost."""

from __future__ import annotations

import os

from graphflow.introspect.costs import Costs


def test_looks() -> None:
    """Those that live, with their nodes; the others are left out and forgotten."""
    costs = Costs()
    [own] = costs.look({os.getpid(): ["/a", "/b"], 2**22 + 1: ["/gone"]})
    assert (own.pid, own.nodes) == (os.getpid(), ["/a", "/b"])
    assert own.memory > 1_000_000
    assert own.threads >= 1
    assert own.seconds > 0
    assert costs.look({}) == []
    assert not costs._known


def test_order() -> None:
    """The dearest first, by processor or memory."""
    owners = {os.getpid(): ["/a"], os.getppid(): ["/b"]}
    for by_memory in (False, True):
        found = Costs().look(owners, by_memory=by_memory)
        key = [cost.memory if by_memory else cost.cpu for cost in found]
        assert key == sorted(key, reverse=True)
        assert len(found) == 2
