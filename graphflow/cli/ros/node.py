"""`graphflow node list` and `info`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import click

from graphflow.cli import output
from graphflow.cli.verbs import GraphVerbs
from graphflow.domain import domain_id
from graphflow.introspect.empty_hint import nothing_here
from graphflow.introspect.graph_view import View
from graphflow.machines.cache import ACTION_FEEDBACK, ACTION_FEEDBACK_TYPE, GraphCache
from graphflow.names import is_hidden
from graphflow.qos import Qos
from graphflow.wire.liveliness import Kind

_SECTIONS = (
    ("Subscribers", Kind.SUBSCRIPTION),
    ("Publishers", Kind.PUBLISHER),
    ("Service Servers", Kind.SERVICE),
    ("Service Clients", Kind.CLIENT),
)
_ACTION_SECTIONS = (("Action Servers", Kind.PUBLISHER), ("Action Clients", Kind.SUBSCRIPTION))


class _NodeVerbs(GraphVerbs):
    def order_hint(self, ctx: click.Context, words: Sequence[str]) -> str:
        word, *rest = words
        if word not in ("kill", "stop", "start", "restart", "status"):
            return ""
        from graphflow.cli.graphs.nodes import by_itself

        verb = " ".join(["stop" if word == "kill" else word, *rest])
        alone = by_itself(f"/{rest[0].lstrip('/')}") if rest and not rest[0].startswith("-") else ""
        return alone or f"to control nodes: graphflow {verb}"


@click.group(cls=_NodeVerbs)
def node() -> None:
    """List and describe nodes."""


@node.command(name="list")
@click.option("-a", "--all", "--include-hidden-nodes", "everything", is_flag=True, help="Include hidden nodes.")
@click.option("-c", "--count-nodes", is_flag=True, help="Print only the count.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def list_(everything: bool, count_nodes: bool, as_json: bool) -> None:
    """List the names of all nodes."""
    with View(domain_id()) as view:
        names = view.cache.nodes(hidden=everything)
    if as_json:
        output.as_json(names)
    elif count_nodes:
        output.data(str(len(names)))
    else:
        output.lines(names)
        _warn_of_twins(names)
        if not names:
            output.talk(nothing_here("no nodes"))


def _warn_of_twins(names: list[str]) -> None:
    twins = [name for name, count in Counter(names).items() if count > 1]
    if twins:
        output.talk(
            "WARNING: Be aware that there are nodes in the graph that share an exact name, "
            f"which can have unintended side effects: {', '.join(twins)}"
        )


@node.command()
@click.argument("name", metavar="NODE")
@click.option("--include-hidden", is_flag=True, help="Include hidden topics, services and actions.")
@click.option("-v", "--verbose", is_flag=True, help="Also show each endpoint's QoS.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def info(name: str, include_hidden: bool, verbose: bool, as_json: bool) -> None:
    """Show a node's publishers, subscriptions, services and actions."""
    with View(domain_id()) as view:
        full = view.node(name)
        cache = view.cache
    if as_json:
        output.as_json({"node": full, **_as_dict(cache, full, include_hidden)})
        return
    _warn_of_twins([n for n in cache.nodes() if n == full])
    output.data(full)
    for title, kind in _SECTIONS:
        output.data(f"  {title}:")
        for e in cache.endpoints(kind, node=full):
            if include_hidden or not is_hidden(e.name):
                qos = f"  ({_qos_text(e.qos)})" if verbose else ""
                output.data(f"    {e.name}: {e.type}{qos}")
        if kind is Kind.CLIENT:
            output.data("")
    for title, kind in _ACTION_SECTIONS:
        output.data(f"  {title}:")
        for e in cache.endpoints(kind, node=full):
            if e.name.endswith(ACTION_FEEDBACK):
                output.data(f"    {e.name.removesuffix(ACTION_FEEDBACK)}: {e.type.removesuffix(ACTION_FEEDBACK_TYPE)}")
    output.data("")


def _qos_text(qos: Qos) -> str:
    return f"{qos.reliability.name}, {qos.durability.name}, {qos.history.name} ({qos.depth})"


def _as_dict(cache: GraphCache, name: str, hidden: bool) -> dict[str, dict[str, str]]:
    return {
        title.lower().replace(" ", "_"): {
            e.name: e.type for e in cache.endpoints(kind, node=name) if hidden or not is_hidden(e.name)
        }
        for title, kind in _SECTIONS
    }
