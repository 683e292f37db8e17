"""What is drawn of a graph: nodes, topics and the arrows between them; also in the words of Mermaid and Graphviz."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from graphflow.machines.cache import GraphCache
from graphflow.machines.matching import verdict
from graphflow.names import is_hidden
from graphflow.wire.liveliness import Entity, Kind

_EVERYWHERE = ("/rosout", "/parameter_events", "/clock")
"""Topics that every node has: they would be in every picture."""


class Arrow(NamedTuple):
    """A node publishes to a topic, or a topic reaches a node."""

    source: str
    target: str
    is_bad: bool = False


class Picture(NamedTuple):
    """What is to be drawn."""

    nodes: tuple[str, ...]
    topics: tuple[str, ...]
    arrows: tuple[Arrow, ...]


def picture(cache: GraphCache, below: str, collapsed: frozenset[str], *, everything: bool) -> Picture:
    """Nodes, topics and the arrows between them.

    Args:
        below: Only nodes of this namespace and what they are connected to; empty for all.
        collapsed: Namespaces drawn as one box each.
        everything: Also topics that only one side knows, and those that every node has.
    """
    ends: dict[str, list[Entity]] = {}
    for e in cache:
        if e.kind in (Kind.PUBLISHER, Kind.SUBSCRIPTION) and not is_hidden(e.name) and not is_hidden(e.node_name):
            ends.setdefault(e.name, []).append(e)
    nodes = dict.fromkeys(box_of(n, collapsed) for n in cache.nodes(hidden=False) if n.startswith(below))
    arrows: dict[Arrow, None] = {}
    topics: dict[str, None] = {}
    for topic, there in sorted(ends.items()):
        kinds = {e.kind for e in there}
        near = any(e.node_name.startswith(below) for e in there)
        if not near or (not everything and (len(kinds) < 2 or topic in _EVERYWHERE)):
            continue
        sources = {box_of(e.node_name, collapsed) for e in there if e.kind is Kind.PUBLISHER}
        targets = {box_of(e.node_name, collapsed) for e in there if e.kind is Kind.SUBSCRIPTION}
        if sources == targets and len(sources) == 1 and not everything:
            continue  # it stays within one box
        bad = bool(misfit(there))
        topics[topic] = None
        nodes.update(dict.fromkeys((*sorted(sources), *sorted(targets))))
        arrows.update(dict.fromkeys(Arrow(s, topic, bad) for s in sorted(sources)))
        arrows.update(dict.fromkeys(Arrow(topic, t, bad) for t in sorted(targets)))
    return Picture(tuple(nodes), tuple(topics), tuple(arrows))


def box_of(node: str, collapsed: Iterable[str]) -> str:
    """The box that a node is drawn in: its own, or that of a namespace."""
    found = [space for space in collapsed if node.startswith(f"{space}/")]
    return f"{max(found, key=len)}/…" if found else node


def misfit(there: list[Entity]) -> str:
    """What keeps a publisher and a subscription of a topic apart, in a few words; empty for nothing."""
    for publisher in there:
        for other in there:
            if publisher.kind is Kind.PUBLISHER and other.kind is Kind.SUBSCRIPTION:
                found = verdict(publisher, other)
                if found is not None and found.complaint:
                    return ", ".join(found.policies) or "type"
    return ""


def mermaid(made: Picture) -> str:
    """A flow chart of Mermaid; what does not fit together is red."""
    ids = {name: f"n{i}" for i, name in enumerate((*made.nodes, *made.topics))}
    lines = ["flowchart LR"]
    lines += [f'  {ids[n]}(["{n}"])' for n in made.nodes]
    lines += [f'  {ids[t]}["{t}"]' for t in made.topics]
    lines += [f"  {ids[a.source]} --> {ids[a.target]}" for a in made.arrows]
    bad = [str(i) for i, arrow in enumerate(made.arrows) if arrow.is_bad]
    return "\n".join([*lines, *([f"  linkStyle {','.join(bad)} stroke:red"] if bad else [])])


def dot(made: Picture) -> str:
    """A digraph of Graphviz; what does not fit together is red."""
    lines = ["digraph graphflow {", "  rankdir=LR;", "  node [fontname=sans];"]
    lines += [f'  "{n}" [shape=ellipse];' for n in made.nodes]
    lines += [f'  "{t}" [shape=box, color=gray40];' for t in made.topics]
    lines += [f'  "{a.source}" -> "{a.target}"{" [color=red]" if a.is_bad else ""};' for a in made.arrows]
    return "\n".join([*lines, "}"])
