"""Planning of a node that joins a running graph."""

from __future__ import annotations

from graphflow.errors import Place, Problem
from graphflow.graph.checks.check import check
from graphflow.graph.plan import Plan, PlannedNode, Rule, Setting
from graphflow.interface import Interface
from graphflow.names import check_namespace, check_node_name, join
from graphflow.runtime.args import RosArgs

GIVEN = Place("command line")


def planned_component(interface: Interface, name: str, namespace: str, ros: RosArgs, log_level: str) -> PlannedNode:
    """Plan a node as a graph file would.

    Args:
        ros: Its remaps and parameters.

    Raises:
        InvalidName: The name or the namespace is not legal.
    """
    return PlannedNode(
        name=join(check_namespace(namespace), check_node_name(name)),
        class_path=interface.class_path,
        place=GIVEN,
        class_place=GIVEN,
        params={key: Setting(value, GIVEN) for key, (value, _) in ros.params_for(interface).items()},
        remaps=tuple(Rule(rule.match, rule.replacement, GIVEN) for rule in ros.remaps),
        log_level=log_level,
    )


def check_component(node: PlannedNode, interface: Interface) -> list[Problem]:
    """Return every problem of the node: unknown parameters and names, and values of the wrong type."""
    plan = Plan("", "", "", (node,))
    return check(plan, {node.class_path: interface})
