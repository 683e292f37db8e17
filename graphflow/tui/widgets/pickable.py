"""The entries of pickers: views, and everything in the graph that has a view."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from graphflow.console.views import VIEWS, known_views
from graphflow.errors import GraphflowError
from graphflow.names import is_hidden
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.registry import describe
from graphflow.tui.widgets.dialogs import Item
from graphflow.wire.liveliness import Kind

if TYPE_CHECKING:
    from graphflow.introspect.graph_view import View as Graph

NODES = 100
"""Maximum nodes whose parameters are listed."""
REPLY_TIMEOUT = 1.0


def contents(hub: Hub) -> list[Item]:
    """Return the views that need no subject, then those of each thing in the graph."""
    plain = [name for name in known_views() if name not in VIEWS or not VIEWS[name].needs_it]
    return [*(Item(name, describe(name), Content(name)) for name in plain), *things(hub)]


def things(hub: Hub) -> list[Item]:
    """Return nodes, topics, services and actions, each with the views of it."""
    found = []
    for node in hub.nodes():
        found += [Item(f"log {node}", "what it writes", Content("log", node))]
        found += [Item(f"params {node}", "its parameters", Content("params", node))]
    if hub.live is None:
        return found
    cache = hub.live.cache
    for topic, types in cache.topics().items():
        found += [Item(f"echo {topic}", ", ".join(types), Content("echo", topic))]
        found += [Item(f"hz {topic}", ", ".join(types), Content("hz", topic))]
    for entity in cache.endpoints(Kind.SERVICE):
        if not is_hidden(entity.name):
            found.append(Item(f"call {entity.name}", entity.type, Content("calls", entity.name)))
    for action, types in cache.actions().items():
        found.append(Item(f"goals {action}", ", ".join(types), Content("goals", action)))
    return found


def _names(graph: Graph, node: str) -> list[str]:
    from graphflow.introspect.parameters import RemoteParameters

    return RemoteParameters(graph, node, REPLY_TIMEOUT).names()


async def parameters(hub: Hub) -> list[Item]:
    """Return the parameters of all nodes that reply, each with the parameter view of its node."""
    live = hub.live
    if live is None or live.context is None:
        return []
    found: list[Item] = []
    servers = {e.node_name for e in live.cache.endpoints(Kind.SERVICE) if e.name.endswith("/list_parameters")} & set(
        hub.nodes()
    )
    for node in sorted(servers)[:NODES]:
        try:
            names = await live.ask(partial(_names, node=node))
        except GraphflowError:
            continue  # a node that does not reply is only missing from the list
        found += [Item(f"param {name}", node, Content("params", node)) for name in names]
    return found
