"""One node that is to join a running graph, as a graph file would plan it."""

from __future__ import annotations

from graphflow.errors import Place, Problem
from graphflow.graph.checks.check import check
from graphflow.graph.plan import Plan, PlannedNode, Rule, Setting
from graphflow.interface import Interface
from graphflow.names import check_namespace, check_node_name, join
from graphflow.runtime.args import RosArgs

GIVEN = Place("command line")


def planned_component(interface: Interface, name: str, namespace: str, ros: RosArgs, log_level: str) -> PlannedNode:
    """The node.

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
    """Every problem of the node: parameters and names that its class does not have, values that do not fit."""
    plan = Plan("", "", "", (node,))
    return check(plan, {node.class_path: interface})
