"""What a console shows first: the nodes, their logs and, where there is a turtle, the turtle."""

from __future__ import annotations

from graphflow.tui.hub import Hub
from graphflow.tui.layout import Layout
from graphflow.tui.panes import Content, Pane, Split


def home(layout: Layout, hub: Hub) -> Pane | Split:
    """The first window of a graph that says nothing of windows."""
    nodes = layout.make_pane(Content("nodes"), 40.0)
    log = layout.make_pane(Content("log"), 60.0)
    if not _draws(hub):
        log.share, nodes.share = 60.0, 40.0
        return Split("rows", [nodes, log])
    left = Split("rows", [nodes, log], 52.0)
    return Split("columns", [left, layout.make_pane(Content("turtle"), 48.0)])


def _draws(hub: Hub) -> bool:
    """Whether a node of the graph is turtlesim."""
    rows = hub.supervision.nodes.values() if hub.supervision is not None else ()
    return any("turtlesim" in row["class"].lower() for row in rows)
