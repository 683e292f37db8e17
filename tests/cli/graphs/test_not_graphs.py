"""Words in the place of a graph that are nodes."""

from __future__ import annotations

from dataclasses import replace

import pytest

from graphflow.cli.graphs import not_graphs
from graphflow.cli.graphs.not_graphs import answer
from graphflow.domain import domain_id
from graphflow.errors import SupervisorError
from graphflow.supervisor import rundir
from graphflow.supervisor.rundir import GraphRun

HERE = GraphRun(
    run_id="r",
    graph="lab",
    domain=domain_id(),
    pid=1,
    started=0.0,
    began=0.0,
    file="/nowhere/lab.yaml",
    socket="lab",
    logs="",
    endpoint="",
    plan_hash="",
)
ELSEWHERE = replace(HERE, graph="robot", domain=domain_id() + 1, socket="robot")
RUNS = [(ELSEWHERE, ["/arm/left", "/talker"]), (HERE, ["/talker", "/turtle2/chaser"])]


@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("/turtle2/chaser", "of the graph lab; stop it with: graphflow stop /turtle2/chaser"),
        ("talker", "of the graph lab; stop it with: graphflow stop /talker"),
        ("/arm/left", "of the graph robot; stop it with: graphflow stop /arm/left --graph robot"),
    ],
)
def test_a_node(word: str, told: str) -> None:
    """Comes with the command that stops it, and with its graph if that is elsewhere."""
    assert answer(word, RUNS) == f"/{word.strip('/')} is a node {told}"


@pytest.mark.parametrize("word", ["lab", "/turtle2", "nobody", "/"])
def test_other_words(word: str) -> None:
    """Are no nodes."""
    assert answer(word, RUNS) == ""


def test_running_graphs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Are asked for their nodes; one that is just ending does not answer."""

    def rows(socket: str) -> list[dict[str, str]]:
        if socket == "robot":
            raise SupervisorError("it has ended")
        return [{"node": "/talker"}]

    monkeypatch.setattr(rundir, "running", lambda: [ELSEWHERE, HERE])
    monkeypatch.setattr("graphflow.cli.graphs.node_rows.node_rows", rows)
    assert list(not_graphs.running()) == [(HERE, ["/talker"])]
