"""The order of nodes and steps: `after` by full names, without cycles."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
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
    """Resolve the names in every `after`; report unknown names and cycles.

    Nodes and steps left out by a condition are dropped from `after`.
    """
    names = _Names(src, nodes, {*nodes, *(s.name for s in steps)}, expansion, problems)
    keys = {*nodes, *(expansion.written[name][0] for name in nodes)}
    for step in steps:
        if step.name in keys:
            problems.add(step.place, f"a node is already called {step.name!r}; give the step another name")
    ordered_nodes = [replace(node, after=names.resolved(node, "nodes")) for node in nodes.values()]
    ordered_steps = [replace(step, after=names.resolved(step, "steps")) for step in steps]
    items: list[PlannedNode | PlannedStep] = [*ordered_nodes, *ordered_steps]
    places = {item.name: item.place for item in items}
    cycle = find_cycle({item.name: item.after for item in items}) or _process_cycle(items, places)
    if cycle:
        ring = " after ".join([*cycle, cycle[0]])
        problems.add(places[cycle[0]], f"waits for itself: {ring}; remove one of these after:")
    return ordered_nodes, ordered_steps


class _Names:
    """The names of a graph, as `after` refers to them.

    Args:
        known: Names of nodes and steps.
    """

    def __init__(
        self, src: Source, nodes: Collection[str], known: set[str], expansion: Expansion, problems: Problems
    ) -> None:
        self._src, self._nodes, self._known, self._expansion, self._problems = src, nodes, known, expansion, problems
        self._by_key: dict[str, list[str]] = {}
        for name in known & expansion.written.keys():
            self._by_key.setdefault(expansion.written[name][0], []).append(name)

    def resolved(self, item: PlannedNode | PlannedStep, section: str) -> dict[str, str]:
        """Return the `after` of a node or step by full names, each with its condition."""
        namespace = self._expansion.written.get(item.name, ("", "/"))[1]
        found: dict[str, str] = {}
        for i, (written, condition) in enumerate(item.after.items()):
            name = self._full_name(written, namespace)
            if name in self._known:
                found[name] = condition or ("ready" if name in self._nodes else "done")
            elif name not in self._expansion.left_out and written not in self._expansion.refused:
                path: Path = (section, item.name, "after")
                place = self._src.place((*path, i if (*path, i) in self._src.places else written))
                hint = did_you_mean(written, self._known | self._expansion.refused)
                self._problems.add(place, f"after: there is no node or step {written!r}{hint}")
        return found

    def _full_name(self, written: str, namespace: str) -> str:
        near = join(namespace, written)
        name = near if near in self._known or near in self._expansion.left_out else written
        if name not in self._known and len(self._by_key.get(written, ())) == 1:
            [name] = self._by_key[written]
        return name


def _process_cycle(items: list[PlannedNode | PlannedStep], places: dict[str, Place]) -> list[str]:
    """Return a cycle among processes, each of which starts as a whole, after the predecessors of all its nodes."""
    whole = {i.name: f"process {i.process}" for i in items if isinstance(i, PlannedNode) and i.process}
    edges: dict[str, set[str]] = {}
    for item in items:
        name = whole.get(item.name, item.name)
        places.setdefault(name, item.place)
        edges.setdefault(name, set()).update({whole.get(a, a) for a in item.after} - {name})
    return find_cycle({name: sorted(after) for name, after in edges.items()})


def find_cycle(edges: Mapping[str, Iterable[str]]) -> list[str]:
    """Return the names in a cycle, each after the next; empty if there is none."""
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
