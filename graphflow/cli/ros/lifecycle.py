"""`graphflow lifecycle`: nodes, get, list and set."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import click

from graphflow.cli import exits, output
from graphflow.cli.verbs import GraphVerbs
from graphflow.domain import domain_id
from graphflow.errors import CallError, UsageFault
from graphflow.introspect import server_logs
from graphflow.introspect.empty_hint import nothing_here
from graphflow.introspect.graph_view import View
from graphflow.introspect.lifecycles import change, managed_nodes, state, transitions
from graphflow.names import did_you_mean, is_hidden

if TYPE_CHECKING:
    from graphflow.msgs.lifecycle_msgs.msg import State


@click.group(cls=GraphVerbs)
def lifecycle() -> None:
    """Show and change the states of lifecycle nodes."""


_hidden = click.option("-a", "--all", "--include-hidden-nodes", "hidden", is_flag=True, help="Include hidden nodes.")
_found_anyway = click.option("--include-hidden-nodes", is_flag=True, hidden=True, expose_value=False)
"""ROS 2's option of verbs that name their node."""
_timeout = click.option("--timeout", type=click.FloatRange(0, min_open=True), default=2.0, help="Seconds to wait.")


@lifecycle.command()
@_hidden
@click.option("-c", "--count-nodes", is_flag=True, help="Print only the count.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def nodes(hidden: bool, count_nodes: bool, as_json: bool) -> None:
    """List the lifecycle nodes."""
    with View(domain_id()) as view:
        found = _managed(view, hidden=hidden)
    if as_json:
        output.as_json(found)
    elif count_nodes:
        output.data(str(len(found)))
    else:
        output.lines(found)
        if not found:
            output.talk(nothing_here("no lifecycle nodes"))


@lifecycle.command()
@click.argument("name", metavar="[NODE]", required=False)
@_hidden
@_timeout
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def get(name: str | None, hidden: bool, timeout: float, as_json: bool) -> None:
    """Show the state of one lifecycle node or of all."""
    found: dict[str, State] = {}
    with View(domain_id()) as view:
        for node in [_node(view, name)] if name else _managed(view, hidden=hidden):
            try:
                found[node] = state(view, node, timeout)
            except CallError as error:
                if name:
                    raise
                output.talk(f"{node}: {error}")
    if as_json:
        output.as_json({node: {"id": now.id, "label": now.label} for node, now in found.items()})
        return
    for node, now in found.items():
        output.data(f"{'' if name else f'{node}: '}{now.label} [{now.id}]")


@lifecycle.command(name="list")
@click.argument("name", metavar="NODE")
@click.option(
    "-a", "--all", "everything", is_flag=True, help="Show the transitions of all states, not only of the current one."
)
@_found_anyway
@_timeout
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def list_(name: str, everything: bool, timeout: float, as_json: bool) -> None:
    """List the transitions that a node can make from its current state."""
    with View(domain_id()) as view:
        found = transitions(view, _node(view, name), timeout, everything=everything)
    if as_json:
        rows = [(t.transition, t.start_state.label, t.goal_state.label) for t in found]
        output.as_json([{"id": t.id, "label": t.label, "start": start, "goal": goal} for t, start, goal in rows])
        return
    for t in found:
        output.data(f"- {t.transition.label} [{t.transition.id}]")
        output.data(f"\tStart: {t.start_state.label}\n\tGoal: {t.goal_state.label}")


@lifecycle.command(name="set")
@click.argument("name", metavar="NODE")
@click.argument("transition", metavar="TRANSITION")
@_found_anyway
@click.option(
    "--timeout", type=click.FloatRange(0, min_open=True), default=60.0, show_default=True, help="Seconds to wait."
)
def set_(name: str, transition: str, timeout: float) -> int:
    """Trigger a transition. It is configure, activate, deactivate, cleanup or shutdown, or its number."""
    with View(domain_id()) as view:
        node = _node(view, name)
        ways = {t.transition.label: t.transition for t in transitions(view, node, timeout)}
        wanted = ways.get(transition) or next((t for t in ways.values() if str(t.id) == transition), None)
        if wanted is None:
            label = state(view, node, timeout).label
            if transition == label or (transition, label) == ("activate", "active"):
                output.error(f"{node} is {label} already")
                return exits.FAILED
            output.error(f"{node} is {label}, which has no transition {transition!r}{did_you_mean(transition, ways)}")
            output.talk("Unknown transition requested, available ones are:")
            for t in ways.values():
                output.talk(f"- {t.label} [{t.id}]")
            return exits.FAILED
        with view.hear(server_logs.TOPIC, server_logs.TYPE, server_logs.BOUND) as logs:
            if change(view, node, wanted, timeout):
                output.data("Transitioning successful")
                return exits.OK
            output.talk("Transitioning failed")
            time.sleep(server_logs.PATIENCE)
            reasons = server_logs.lines(server_logs.read(logs.take()), {node})
        why = "" if reasons else f"; its log says why: graphflow logs --node {node}, or its terminal"
        output.error(f"{node} is {state(view, node, timeout).label}{why}")
        for reason in reasons:
            output.talk(reason)
        return exits.FAILED


def _managed(view: View, *, hidden: bool) -> list[str]:
    return [node for node in managed_nodes(view.cache) if hidden or not is_hidden(node)]


def _node(view: View, name: str) -> str:
    """Return the full name of a lifecycle node.

    Raises:
        CallError: There is no such node.
        UsageFault: It is not a lifecycle node.
    """
    node, managed = name if name.startswith("/") else f"/{name}", _managed(view, hidden=True)
    if node in managed:
        return node
    if node not in view.cache.nodes():
        near = did_you_mean(node, managed) if managed else "; there are no lifecycle nodes here"
        raise CallError(f"there is no node {node}{near}")
    others = f"; lifecycle nodes: {', '.join(managed)}" if managed else "; there are none here"
    raise UsageFault(f"{node} is not a lifecycle node{others}")
