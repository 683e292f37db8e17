"""Answers for words in the place of a node that are something else: a graph, a namespace, a topic, a service."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from graphflow.errors import GraphflowError
from graphflow.introspect.graph_view import View
from graphflow.supervisor.rundir import GraphRun
from graphflow.workspace.project import shown

_DOES = {
    "start": "starts nodes",
    "stop": "stops nodes",
    "restart": "restarts nodes",
    "status": "is about a node",
    "wait": "waits for nodes",
}
"""The verbs that take nodes."""
_WHOLE = {
    "start": "the whole graph is started by: graphflow up {file}",
    "stop": "the whole graph is stopped by: graphflow down --graph {graph}",
    "restart": "the whole graph is restarted by: graphflow down --graph {graph}, then graphflow up {file}",
    "status": "all its nodes are listed by: graphflow ps --graph {graph}",
    "wait": "all its nodes are awaited by: graphflow wait --graph {graph}",
}
_SHOWN = 3
"""Most nodes of a namespace that an answer lists."""


def answer(verb: str, word: str, run: GraphRun, nodes: Collection[str]) -> str:
    """Return the error text for a word that is no node of a graph but something else; empty if it is nothing known.

    Args:
        verb: Such as `stop`.
        word: As it was given.
        nodes: The nodes of the graph, by full name.
    """
    if what := _as_graph(word, run):
        return f"{what}, and {verb} {_DOES[verb]}; " + _WHOLE[verb].format(graph=run.graph, file=shown(Path(run.file)))
    full = f"/{word.strip('/')}"
    if inside := [node for node in nodes if node.startswith(f"{full}/")]:
        more = f" and {len(inside) - _SHOWN} more" if len(inside) > _SHOWN else ""
        return f"{full} is a namespace, with {', '.join(inside[:_SHOWN])}{more}"
    return f"{what}, and {verb} {_DOES[verb]}{_instead(verb, full, what)}" if (what := _on_network(full, run)) else ""


def _as_graph(word: str, run: GraphRun) -> str:
    name = word.removeprefix("/")
    if name.endswith((".yaml", ".yml")):
        return f"{word} is a graph file"
    if name == run.graph:
        return f"{word} is the graph"
    return f"{word} is no node" if name in ("all", "*") else ""


def _on_network(full: str, run: GraphRun) -> str:
    """Return what has a name in the running graph, if it is no node."""
    if not run.is_here:
        return ""
    try:
        with View(run.domain) as view:
            kinds = ("an action", view.cache.actions()), ("a topic", view.cache.topics(hidden=True))
            for kind, names in (*kinds, ("a service", view.cache.services(hidden=True))):
                if full in names:
                    return f"{full} is {kind}"
    except GraphflowError:  # it is just ending
        pass
    return ""


def _instead(verb: str, full: str, what: str) -> str:
    wait = verb == "wait" and what.endswith("a topic")
    return f"; a message is awaited by: graphflow topic echo --once {full}" if wait else ""
