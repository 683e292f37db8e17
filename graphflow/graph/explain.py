"""Explanations of a graph's names: the name in the class, the namespace, and the remap rule, with their places."""

from __future__ import annotations

from collections.abc import Iterator

from graphflow.graph.checks.check import Interfaces, resolver
from graphflow.graph.plan import Plan, PlannedNode
from graphflow.interface import Interface
from graphflow.names import Kind

_VERBS = {
    "publisher": "publishes",
    "subscription": "subscribes to",
    "service": "offers",
    "client": "calls",
    "action": "serves",
    "action client": "sends goals to",
}


def names(plan: Plan, interfaces: Interfaces) -> dict[str, list[str]]:
    """Return lines that explain each name of a graph: nodes, topics, services and actions.

    Names made at run time are not included.
    """
    found: dict[str, list[str]] = {}
    for node in plan.nodes:
        found[node.name] = list(_of_node(node))
    for node in plan.nodes:
        interface = interfaces.get(node.class_path)
        if isinstance(interface, Interface):
            for name, lines in _of_endpoints(node, interface):
                found.setdefault(name, []).extend(lines)
    for step in plan.steps:
        found.setdefault(step.target, []).append(f"step {step.name} has it ({step.do}, {step.target_place})")
    return found


def _of_node(node: PlannedNode) -> Iterator[str]:
    what = f"the program {node.executable or node.command[0]}" if node.command else f"a node of class {node.class_path}"
    yield f"{what}, named at {node.place}"
    for name, setting in node.params.items():
        yield f"  its parameter {name} is {setting.value!r} ({setting.place})"


def _of_endpoints(node: PlannedNode, interface: Interface) -> Iterator[tuple[str, list[str]]]:
    names = resolver(node)
    for endpoint in interface.endpoints:
        kind: Kind = "topic" if endpoint.kind in ("publisher", "subscription") else "service"
        name = names.resolve(endpoint.name, kind)
        how = names.derivations[names.full(endpoint.name)]
        type_ = f" [{endpoint.type}]" if endpoint.type else ""
        lines = [f"{node.name} {_VERBS[endpoint.kind]} it as {endpoint.name!r} ({endpoint.place}){type_}"]
        if how.expanded != how.given:
            of = "the node's own name" if how.given.startswith("~") else f"the namespace {names.namespace}"
            lines.append(f"  {how.given} is {how.expanded}, by {of} ({node.place})")
        if how.rule is not None:
            lines.append(f"  {how.expanded} is {how.resolved}, by the remap {how.rule} ({how.rule.source})")
        yield name, lines
