"""Words in the place of a node that are something else."""

from __future__ import annotations

from dataclasses import replace

import pytest

from graphflow.cli.graphs.not_nodes import answer
from graphflow.supervisor.rundir import GraphRun

RUN = GraphRun(
    run_id="r",
    graph="lab",
    domain=7,
    pid=1,
    started=0.0,
    began=0.0,
    file="/nowhere/lab.yaml",
    socket="",
    logs="",
    endpoint="tcp/nowhere:1",
    plan_hash="",
)
NODES = ("/arm/left", "/arm/right", "/talker")


@pytest.mark.parametrize(
    ("verb", "word", "told"),
    [
        (
            "stop",
            "graphs/lab.yaml",
            "graphs/lab.yaml is a graph file, and stop stops nodes; the whole graph is stopped by: "
            "graphflow down --graph lab",
        ),
        (
            "restart",
            "all",
            "all is no node, and restart restarts nodes; the whole graph is restarted by: "
            "graphflow down --graph lab, then graphflow up /nowhere/lab.yaml",
        ),
        (
            "wait",
            "lab",
            "lab is the graph, and wait waits for nodes; all its nodes are awaited by: graphflow wait --graph lab",
        ),
        ("status", "arm", "/arm is a namespace, with /arm/left, /arm/right"),
        ("stop", "/arm/", "/arm is a namespace, with /arm/left, /arm/right"),
        ("stop", "/talkr", ""),
        ("stop", "/", ""),
    ],
)
def test_answers(verb: str, word: str, told: str) -> None:
    """Each says what the word is, and the command for it; nothing is said of a name that is unknown."""
    assert answer(verb, word, RUN, NODES) == told


def test_a_large_namespace() -> None:
    """Only its first nodes are listed."""
    text = answer("stop", "arm", replace(RUN), [f"/arm/n{i}" for i in range(9)])
    assert text == "/arm is a namespace, with /arm/n0, /arm/n1, /arm/n2 and 6 more"
