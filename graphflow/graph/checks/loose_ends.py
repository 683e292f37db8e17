"""Loose ends of a plan: names without a counterpart in the graph, and classes that an included file may not mean.

Any of them may be intended, so they are warnings.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from graphflow.errors import Place, Problem
from graphflow.graph.checks.check import Interfaces, remarks_on_programs, resolver
from graphflow.graph.checks.panes import odd_panes
from graphflow.graph.plan import Plan, PlannedNode, PlannedStep, StepKind
from graphflow.interface import EndpointKind, Interface, may_make
from graphflow.names import EVERYBODYS, Kind, nearest, split, without_slash
from graphflow.workspace.project import project_root, shown

_OTHER_END: Mapping[EndpointKind, tuple[EndpointKind, str]] = {
    "publisher": ("subscription", "subscribes to"),
    "subscription": ("publisher", "publishes"),
    "client": ("service", "offers the service"),
    "service": ("client", "calls"),
    "action client": ("action", "offers the action"),
    "action": ("action client", "sends goals to"),
}
_NEEDS_ONE = ("subscription", "client", "action client")
"""Endpoints that do nothing without a counterpart; others may serve clients outside of the graph."""
_STEPS: Mapping[StepKind, EndpointKind] = {"call": "client", "goal": "action client"}
_SHOWN = 4
"""Nodes that a warning names, at most."""
_KINDS: Mapping[EndpointKind, str] = {
    "publisher": "topic",
    "subscription": "topic",
    "client": "service",
    "service": "service",
    "action client": "action",
    "action": "action",
}
_COMMANDS = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
"""Types of which a robot obeys the latest message."""
_SHARED: Mapping[EndpointKind, str] = {
    "publisher": "publish {}, and the robot obeys the latest",
    "subscription": "subscribe to {}, and all obey each command",
}
"""Effects of sharing commands, by the kind of endpoint."""


class _End(NamedTuple):
    """An endpoint of a node."""

    kind: EndpointKind
    name: str
    type: str
    remapped_at: Place | None
    place: Place
    given: str = ""
    """The name before any remap."""
    node: PlannedNode | None = None


def loose_ends(plan: Plan, interfaces: Interfaces) -> list[Problem]:
    """Return warnings about names without a counterpart, ambiguous classes, and shell syntax in arguments.

    Names are those of steps and remaps, and of endpoints whose counterpart may be misspelt. A graph with programs, or
    with classes that cannot be imported, gets no warnings about names, as some of its names are unknown.
    """
    classes = [*_of_classes(plan, interfaces), *remarks_on_programs(plan)]
    known = [found for found in interfaces.values() if isinstance(found, Interface)]
    if len(known) < len(interfaces) or any(node.command for node in plan.nodes):
        return classes
    ends = [end for node in plan.nodes for end in _ends(node, interfaces)]
    made = [interface.dynamic_names for interface in known]
    classes += (problem for node in plan.nodes for problem in _of_loops(node, interfaces))
    classes += _of_shared_commands(plan, interfaces)
    sure = {name for node in plan.nodes for name in _sure(node, interfaces)}
    of_nodes = [*_of_nodes(ends, sure)]
    found = [
        *_of_steps(plan, ends),
        *of_nodes,
        *_apart(ends, {n for n, _ in of_nodes}),
        *odd_panes(plan.panes, _by_kind(plan, ends)),
    ]
    may_exist = [name for name, _ in found if any(may_make(names, name) for names in made)]
    return classes + [problem for name, problem in found if name not in may_exist or _nearest(name, sure)]


def _sure(node: PlannedNode, interfaces: Interfaces) -> Iterator[str]:
    """Yield the topics that a node surely creates at run time: patterns with a `*` for its namespace alone."""
    interface = interfaces[node.class_path]
    assert isinstance(interface, Interface)
    for pattern in interface.dynamic_names if not isinstance(interface.dynamic_names, bool) else ():
        if pattern.startswith("*/") and not set(pattern[1:]) & set("*?["):
            yield resolver(node).resolve(pattern[2:])


def _by_kind(plan: Plan, ends: list[_End]) -> dict[str, dict[str, str]]:
    """Return the names of the graph with their types, by kind."""
    found: dict[str, dict[str, str]] = {kind: {} for kind in _KINDS.values()}
    found["node"] = {node.name: "" for node in plan.nodes}
    for end in ends:
        found[_KINDS[end.kind]].setdefault(end.name, end.type)
    return found


def _of_classes(plan: Plan, interfaces: Interfaces) -> Iterator[Problem]:
    """Yield classes found in this graph's project while the project of their file has others of the same name."""
    for node in plan.nodes:
        interface = interfaces.get(node.class_path)
        if not isinstance(interface, Interface) or not node.class_place.file:
            continue
        root = project_root(Path(node.class_place.file))
        stem = root.joinpath(*node.class_path.partition(":")[0].split("."))
        own = next((file for file in (stem.with_suffix(".py"), stem / "__init__.py") if file.is_file()), None)
        taken = Path(interface.place.file)
        if own is not None and str(root) != plan.root and not own.samefile(taken):
            text = (
                f"{node.class_path} is that of {shown(taken)}, not that of this file's project, {shown(own)}: "
                "graphs cannot mix modules of one name; give one of the two packages another name"
            )
            yield Problem(node.class_place, text)


def _ends(node: PlannedNode, interfaces: Interfaces) -> Iterator[_End]:
    interface = interfaces[node.class_path]
    assert isinstance(interface, Interface)
    names = resolver(node)
    for endpoint in interface.endpoints:
        kind: Kind = "topic" if endpoint.kind in ("publisher", "subscription") else "service"
        name, full = names.resolve(endpoint.name, kind), names.full(endpoint.name)
        rules = (rule.place for rule in node.remaps if name != full and names.pattern(rule.match).fullmatch(full))
        yield _End(endpoint.kind, name, endpoint.type, next(rules, None), endpoint.place, full, node)


def _of_loops(node: PlannedNode, interfaces: Interfaces) -> Iterator[Problem]:
    """Yield a remap by which a node hears itself; most have their sides exchanged."""
    interface = interfaces[node.class_path]
    assert isinstance(interface, Interface)
    names = resolver(node)
    topics = [end for end in interface.endpoints if end.kind in ("publisher", "subscription")]
    before = {end.name: names.full(end.name) for end in topics}
    sent, heard = ({before[e.name] for e in topics if e.kind == kind} for kind in ("publisher", "subscription"))
    for rule in node.remaps:
        of_rule = [name for name in sent | heard if names.pattern(rule.match).fullmatch(name)]
        for name in of_rule if len(of_rule) == 1 else ():
            after = names.resolve(name)
            if (name in sent and after in heard - sent) or (name in heard and after in sent - heard):
                own = next(given for given, full in before.items() if full == after)
                text = f"by this remap {node.name} hears its own messages on {after}"
                way = f"a remap has the node's name first: did you mean {own}: {rule.match}?"
                yield Problem(rule.place, f"{text}; {way}")
                return


def _of_shared_commands(plan: Plan, interfaces: Interfaces) -> Iterator[Problem]:
    """Yield commands under an absolute name, which nodes of one class in several namespaces publish, or obey."""
    shared: dict[tuple[Place, str, str], list[str]] = {}
    for node in plan.nodes:
        interface = interfaces[node.class_path]
        assert isinstance(interface, Interface)
        for end in interface.endpoints:
            is_absolute = end.name.startswith("/") and resolver(node).resolve(end.name) == end.name
            if is_absolute and end.kind in _SHARED and end.type in _COMMANDS:
                shared.setdefault((end.place, end.name, _SHARED[end.kind]), []).append(node.name)
    for (place, name, verb), nodes in shared.items():
        if len({split(node)[0] for node in nodes}) > 1:
            who = f"{', '.join(nodes[:_SHOWN])} and others" if len(nodes) > _SHOWN else " and ".join(nodes)
            yield Problem(
                place, f"{who} {verb.format(name)}: write {name[1:]!r} without /, so that each namespace has its own"
            )


def _of_steps(plan: Plan, ends: list[_End]) -> Iterator[tuple[str, Problem]]:
    for step in plan.steps:
        kind = _STEPS.get(step.do)
        if step.do == "wait":
            yield from _of_wait(step, plan, ends)
        elif kind is not None and not any(step.target.startswith(f"{node.name}/") for node in plan.nodes):
            # A step that gives the type may mean one outside the graph; one without was checked.
            end = _End(kind, step.target, "", None, step.target_place)
            if near := _nearest(step.target, _others(end, ends)):
                yield step.target, Problem(step.target_place, _text(end, near))


def _of_wait(step: PlannedStep, plan: Plan, ends: list[_End]) -> Iterator[tuple[str, Problem]]:
    known = {node.name for node in plan.nodes} | {end.name for end in ends}
    if step.target not in (*known, *EVERYBODYS):
        hint = _hint(_nearest(step.target, known))
        yield step.target, Problem(step.target_place, f"nothing in this graph is called {step.target}{hint}")


def _of_nodes(ends: list[_End], sure: set[str]) -> Iterator[tuple[str, Problem]]:
    """Yield remapped names without a counterpart, and names that differ little from one; each pair once.

    Args:
        sure: Names that nodes create at run time.
    """
    reported: set[str] = set()
    for end in sorted(ends, key=lambda end: (end.remapped_at is None, end.kind not in _NEEDS_ONE)):
        others = _others(end, ends)
        if end.name in others or end.name in EVERYBODYS:
            continue
        topics = sure if end.kind in ("publisher", "subscription") else set[str]()
        if _within(end) in others | topics:
            if end.name not in reported:  # the nodes of a class share the line
                yield end.name, Problem(end.place, f"{_text(end)}; write {without_slash(end.name)}")
            reported.add(end.name)
            continue
        near = _nearest(end.name, (others | topics) - {same.name for same in ends if same.kind == end.kind})
        if near not in reported if near else end.remapped_at is not None and end.kind in _NEEDS_ONE:
            reported.add(end.name)
            yield end.name, Problem(end.remapped_at or end.place, _text(end, near))


def _apart(ends: list[_End], reported: set[str]) -> Iterator[tuple[str, Problem]]:
    """Yield subscriptions and publishers that lack the other end, and would meet but for a remap or namespace.

    Args:
        reported: Names that are left out.
    """
    alone = [e for e in ends if e.name not in _others(e, ends) and e.name not in (*reported, *EVERYBODYS)]
    for heard in alone:
        for sent in alone if heard.kind == "subscription" else ():
            is_alike = sent.given == heard.name or split(sent.given)[1] == split(heard.name)[1]
            if sent.kind == "publisher" and sent.type == heard.type and is_alike and sent.node and heard.node:
                text = f"{sent.node.name} publishes {sent.name}, and {heard.node.name} subscribes to {heard.name}"
                way = "remap both, or neither" if sent.remapped_at else "put both in one namespace, or remap one"
                yield heard.name, Problem(sent.remapped_at or heard.node.place, f"{text}; for them to meet, {way}")
                break


def _others(end: _End, ends: list[_End]) -> set[str]:
    """Return the names of the possible counterparts of an endpoint."""
    other, _ = _OTHER_END[end.kind]
    return {known.name for known in ends if known.kind == other and (not end.type or known.type in ("", end.type))}


def _within(end: _End) -> str:
    """Return an absolute name as it would be within its node's namespace; empty for other names."""
    namespace = split(end.node.name)[0] if end.node is not None else "/"
    is_absolute = end.remapped_at is None and namespace != "/" and not end.name.startswith(f"{namespace}/")
    return namespace + end.name if is_absolute else ""


def _text(end: _End, near: str = "") -> str:
    return f"no node of this graph {_OTHER_END[end.kind][1]} {end.name}{_hint(near)}"


def _hint(near: str) -> str:
    return f"; did you mean {near!r}?" if near else ""


def _nearest(name: str, known: set[str]) -> str:
    """Return the name that another may be a misspelling of; empty if there is none, or if only digits differ."""
    found = "" if name in known else nearest(name, known, cutoff=0.8) or ""
    return "" if _without_digits(found) == _without_digits(name) else found


def _without_digits(name: str) -> str:
    return "".join(letter for letter in name if not letter.isdigit())
