"""The states of a graph's nodes, from its supervisor."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.cli.graphs.node_rows import graph_rows, node_rows
from graphflow.errors import SupervisorError
from tests.conftest import Machine
from tests.supervisor.running import supervisor_of


@pytest.mark.real
def test_rows_of_a_running_graph(standing: Machine) -> None:
    """All nodes with their states, and no console; the same rows by either function."""
    socket = supervisor_of(standing)["socket"]
    rows = graph_rows(socket)
    assert {row["state"] for row in rows["nodes"]} == {"ready"}
    assert rows["consoles"] == []
    assert node_rows(socket) == rows["nodes"]


def test_no_supervisor(tmp_path: Path) -> None:
    """A socket on which nobody listens is an error, not an empty graph."""
    with pytest.raises(SupervisorError):
        node_rows(str(tmp_path / "none.sock"))
