"""The handlers of a node that send transforms, derived from the source of its class."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace

from graphflow.analysis.class_source import Unknown, source_of
from graphflow.analysis.syntax import children_of
from graphflow.deadlock.closed_world.wakers import entries_of, handlers_above
from graphflow.deadlock.protocols import ProcessContext, Subject
from graphflow.machines.cache import GraphCache
from graphflow.machines.waits.wait_graph import WaitGraph
from graphflow.names import is_hidden
from graphflow.wire.liveliness import Kind

TYPE = "tf2_msgs/msg/TFMessage"

_SENDING = {"send", "send_static"}
"""Methods of a node's transforms that send some."""
_LOOKING_UP = {"lookup", "get", "transform", "chain", "info", "parent"}
NAMES_BOUND = 50
"""Names of frames of one handler, at most."""


class TransformSenders:
    """The handlers of a process's nodes that may send transforms."""

    def __init__(self, process: ProcessContext) -> None:
        self._publish = publishing(process.cache)
        self._found: dict[str, Mapping[str, tuple[str, ...]]] = {}
        """By node: methods, each with the texts in its code."""

    def texts(self, node: Subject, handler: str) -> tuple[str, ...] | None:
        """Return the texts in the code of a handler that may send transforms; None for one that sends none."""
        name = node.full_name
        if name not in self._found:
            is_tool = is_hidden(name)  # one of graphflow's own, which only listens
            anything = dict.fromkeys(entries_of(node), ()) if name in self._publish else {}
            self._found[name] = senders(node, node.transforms) if node.transforms and not is_tool else anything
        return self._found[name].get(handler)


def publishing(cache: GraphCache) -> set[str]:
    """Return the names of the nodes that publish transforms."""
    return {e.node_name for e in list(cache) if e.kind is Kind.PUBLISHER and e.type == TYPE}


def sending(graph: WaitGraph, cache: GraphCache) -> WaitGraph:
    """Return a graph in which all handlers and activities of the nodes that publish transforms may send any."""
    nodes = publishing(cache)
    if not nodes:
        return graph
    activities = {id_: replace(a, sends=() if a.node in nodes else None) for id_, a in graph.activities.items()}
    queues = {id_: replace(q, sends=() if q.node in nodes else None) for id_, q in graph.queues.items()}
    return replace(graph, activities=activities, queues=queues)


def senders(node: Subject, attributes: Collection[str]) -> Mapping[str, tuple[str, ...]]:
    """Return the methods of a node that may send transforms and run as handlers or tasks, with the texts in their code.

    Among the texts are the names of the frames that they send, unless those are computed.

    Args:
        attributes: The attributes of the node with transforms; "" for transforms in no attribute.
    """
    try:
        methods = {method for name in attributes for method in _sending(node, name)}
        found = handlers_above("transforms", methods, node) if methods else None
        if found is not None and found.parts:
            raise Unknown
    except Unknown:  # any may
        return dict.fromkeys(entries_of(node), ())
    return {} if found is None else {name: _texts(node, name) for name in found.handlers}


def _sending(node: Subject, name: str) -> set[str]:
    """Return the methods that send the transforms in an attribute.

    Raises:
        Unknown: Other code may do so.
    """
    source = source_of(node.instance)
    uses = source.uses(name) if name else []
    is_passed_on = any(use.kind not in ("called", "part", "read") or use.is_nested for use in uses)
    is_bound = any(use.kind == "part" and use.name in _SENDING for use in uses)
    if not name or is_passed_on or is_bound or any(use.name in _SENDING for use in source.foreign(name)):
        raise Unknown
    return {use.method for use in uses if use.kind == "called" and use.name in _SENDING}


def _texts(node: Subject, method: str) -> tuple[str, ...]:
    """Return the texts in the code of a method, and of those that it calls; those of lookups are left out."""
    source = source_of(node.instance)
    functions = [function for name in source.below(method) for function in source.methods.get(name, ())]
    found = {text for function in functions for text in _constants(function)}
    return tuple(sorted(text for text in found if text.isprintable() and len(text) < 100)[:NAMES_BOUND])


def _constants(code: ast.AST) -> Iterator[str]:
    todo = [code]
    while todo:
        match todo.pop():
            case ast.Call(func=ast.Attribute(attr=name)) if name in _LOOKING_UP:
                pass
            case ast.Constant(value=str(text)):
                yield text
            case node:
                todo += children_of(node)
