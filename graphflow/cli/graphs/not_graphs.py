"""Answers for words in the place of a graph that are nodes: `graphflow down /talker`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from graphflow.errors import SupervisorError
from graphflow.supervisor.rundir import GraphRun


def answer(word: str, runs: Iterable[tuple[GraphRun, Sequence[str]]]) -> str:
    """Return the error text for a word that is a node of a running graph; empty if it is none.

    Args:
        word: As it was given.
        runs: The running graphs, each with the full names of its nodes.
    """
    full = f"/{word.strip('/')}"
    having = [run for run, nodes in runs if full in nodes]
    here = [run for run in having if run.is_here]
    run = next(iter(here or having), None)
    if run is None:
        return ""
    graph = "" if here else f" --graph {run.graph}"
    return f"{full} is a node of the graph {run.graph}; stop it with: graphflow stop {full}{graph}"


def running() -> Iterable[tuple[GraphRun, Sequence[str]]]:
    """Yield the running graphs with their nodes; those that are just ending are left out."""
    from graphflow.cli.graphs.node_rows import node_rows
    from graphflow.supervisor import rundir

    for run in rundir.running():
        try:
            nodes = [row["node"] for row in node_rows(run.socket)]
        except SupervisorError:
            continue
        yield run, nodes
