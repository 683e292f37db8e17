"""Pictures of a graph: its nodes, topics and the arrows between them; also as Mermaid and Graphviz sources."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from graphflow.machines.cache import GraphCache
from graphflow.machines.matching import verdict
from graphflow.names import is_hidden
from graphflow.wire.liveliness import Entity, Kind

_EVERYWHERE = ("/rosout", "/parameter_events", "/clock")
"""Topics of every node, left out of pictures."""


class Arrow(NamedTuple):
    """An arrow from a publishing node to its topic, or from a topic to a subscribing node."""

    source: str
    target: str
    is_bad: bool = False


class Picture(NamedTuple):
    """The elements of a picture."""

    nodes: tuple[str, ...]
    topics: tuple[str, ...]
    arrows: tuple[Arrow, ...]


def picture(cache: GraphCache, below: str, collapsed: frozenset[str], *, everything: bool) -> Picture:
    """Select the nodes, topics and arrows to draw.

    Args:
        below: Namespace whose nodes are drawn with their connections; empty for all.
        collapsed: Namespaces that are drawn as one box each.
        everything: Whether to include unconnected topics, and those of every node.
    """
    ends: dict[str, list[Entity]] = {}
    for e in cache:
        if e.kind in (Kind.PUBLISHER, Kind.SUBSCRIPTION) and not is_hidden(e.name) and not is_hidden(e.node_name):
            ends.setdefault(e.name, []).append(e)
    nodes = dict.fromkeys(box_of(n, collapsed) for n in cache.nodes(hidden=False) if n.startswith(below))
    arrows: dict[Arrow, None] = {}
    topics: dict[str, None] = {}
    for topic, endpoints in sorted(ends.items()):
        kinds = {e.kind for e in endpoints}
        near = any(e.node_name.startswith(below) for e in endpoints)
        if not near or (not everything and (len(kinds) < 2 or topic in _EVERYWHERE)):
            continue
        sources = {box_of(e.node_name, collapsed) for e in endpoints if e.kind is Kind.PUBLISHER}
        targets = {box_of(e.node_name, collapsed) for e in endpoints if e.kind is Kind.SUBSCRIPTION}
        if sources == targets and len(sources) == 1 and not everything:
            continue  # its arrows would stay within one box
        bad = bool(misfit(endpoints))
        topics[topic] = None
        nodes.update(dict.fromkeys((*sorted(sources), *sorted(targets))))
        arrows.update(dict.fromkeys(Arrow(s, topic, bad) for s in sorted(sources)))
        arrows.update(dict.fromkeys(Arrow(topic, t, bad) for t in sorted(targets)))
    return Picture(tuple(nodes), tuple(topics), tuple(arrows))


def box_of(node: str, collapsed: Iterable[str]) -> str:
    """Return the box in which a node is drawn: its own, or that of a collapsed namespace."""
    found = [space for space in collapsed if node.startswith(f"{space}/")]
    return f"{max(found, key=len)}/…" if found else node


def misfit(endpoints: list[Entity]) -> str:
    """Return the policies that keep a publisher and a subscription of a topic apart; empty if none do."""
    for publisher in endpoints:
        for other in endpoints:
            if publisher.kind is Kind.PUBLISHER and other.kind is Kind.SUBSCRIPTION:
                found = verdict(publisher, other)
                if found is not None and found.complaint:
                    return ", ".join(found.policies) or "type"
    return ""


def mermaid(picture: Picture) -> str:
    """Format a Mermaid flow chart; incompatible connections are red."""
    ids = {name: f"n{i}" for i, name in enumerate((*picture.nodes, *picture.topics))}
    lines = ["flowchart LR"]
    lines += [f'  {ids[n]}(["{n}"])' for n in picture.nodes]
    lines += [f'  {ids[t]}["{t}"]' for t in picture.topics]
    lines += [f"  {ids[a.source]} --> {ids[a.target]}" for a in picture.arrows]
    bad = [str(i) for i, arrow in enumerate(picture.arrows) if arrow.is_bad]
    return "\n".join([*lines, *([f"  linkStyle {','.join(bad)} stroke:red"] if bad else [])])


def dot(picture: Picture) -> str:
    """Format a Graphviz digraph; incompatible connections are red."""
    lines = ["digraph graphflow {", "  rankdir=LR;", "  node [fontname=sans];"]
    lines += [f'  "{n}" [shape=ellipse];' for n in picture.nodes]
    lines += [f'  "{t}" [shape=box, color=gray40];' for t in picture.topics]
    lines += [f'  "{a.source}" -> "{a.target}"{" [color=red]" if a.is_bad else ""};' for a in picture.arrows]
    return "\n".join([*lines, "}"])
