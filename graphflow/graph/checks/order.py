"""What starts after what: every `after` by full names, and nothing that waits for itself."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from graphflow.errors import Place
from graphflow.graph.checks.validation import Problems
from graphflow.graph.expansion.expand import Expansion
from graphflow.graph.plan import PlannedNode, PlannedStep
from graphflow.markup.source import Path, Source
from graphflow.names import did_you_mean, join


def ordered(
    src: Source,
    nodes: Mapping[str, PlannedNode],
    steps: list[PlannedStep],
    expansion: Expansion,
    problems: Problems,
) -> tuple[list[PlannedNode], list[PlannedStep]]:
    """Nodes and steps with the names in every `after` resolved; checks that each is there and none waits for itself.

    What a condition has left out is not waited for.
    """
    known = {*nodes, *(s.name for s in steps)}
    by_key: dict[str, list[str]] = {}
    for name in known & expansion.written.keys():
        by_key.setdefault(expansion.written[name][0], []).append(name)

    def resolved(after: Mapping[str, str], path: Path, namespace: str) -> dict[str, str]:
        found: dict[str, str] = {}
        for i, (written, what) in enumerate(after.items()):
            near = join(namespace, written)
            name = near if near in known or near in expansion.left_out else written
            if name not in known and len(by_key.get(written, ())) == 1:
                [name] = by_key[written]
            if name in known:
                found[name] = what or ("ready" if name in nodes else "done")
            elif name not in expansion.left_out and written not in expansion.refused:
                place = src.place((*path, "after", i if (*path, "after", i) in src.places else written))
                help_ = did_you_mean(written, known | expansion.refused)
                problems.add(place, f"after: there is no node or step {written!r}{help_}")
        return found

    def namespace(name: str) -> str:
        return expansion.written.get(name, ("", "/"))[1]

    keys = {*nodes, *(expansion.written[name][0] for name in nodes)}
    for step in steps:
        if step.name in keys:
            problems.add(step.place, f"a node is already called {step.name!r}; give the step another name")
    ordered_nodes = [replace(n, after=resolved(n.after, ("nodes", n.name), namespace(n.name))) for n in nodes.values()]
    ordered_steps = [replace(s, after=resolved(s.after, ("steps", s.name), namespace(s.name))) for s in steps]
    items: list[PlannedNode | PlannedStep] = [*ordered_nodes, *ordered_steps]
    places = {item.name: item.place for item in items}
    cycle = find_cycle({item.name: item.after for item in items}) or _process_cycle(items, places)
    if cycle:
        ring = " after ".join([*cycle, cycle[0]])
        problems.add(places[cycle[0]], f"waits for itself: {ring}; remove one of these after:")
    return ordered_nodes, ordered_steps


def _process_cycle(items: list[PlannedNode | PlannedStep], places: dict[str, Place]) -> list[str]:
    """A cycle among processes: each is started as a whole, so all its nodes wait for what any of them waits for."""
    whole = {i.name: f"process {i.process}" for i in items if isinstance(i, PlannedNode) and i.process}
    edges: dict[str, set[str]] = {}
    for item in items:
        name = whole.get(item.name, item.name)
        places.setdefault(name, item.place)
        edges.setdefault(name, set()).update({whole.get(a, a) for a in item.after} - {name})
    return find_cycle({name: sorted(after) for name, after in edges.items()})


def find_cycle(edges: Mapping[str, Iterable[str]]) -> list[str]:
    """Names that wait for one another in a cycle, each after the next; empty when there is no cycle."""
    done: set[str] = set()
    for start in edges:
        path: list[str] = []
        stack: list[tuple[str, list[str]]] = [(start, list(edges.get(start, ())))]
        while stack:
            name, rest = stack[-1]
            if name not in path:
                path.append(name)
            if not rest:
                done.add(name)
                path.pop()
                stack.pop()
                continue
            follower = rest.pop()
            if follower in path:
                return path[path.index(follower) :]
            if follower not in done:
                stack.append((follower, list(edges.get(follower, ()))))
    return []
