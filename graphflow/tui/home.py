"""What a console shows first: the nodes, their logs and, where there is a turtle, the turtle."""

from __future__ import annotations

from graphflow.tui.hub import Hub
from graphflow.tui.layout import Layout
from graphflow.tui.panes import Content, Split

LINES = 24
"""Lines of a small terminal, by which the list of nodes gets its share."""


def open_home(layout: Layout, hub: Hub) -> None:
    """Open the first window of a graph that says nothing of windows. A turtle has the focus: arrows drive it."""
    share = min(60.0, max(25.0, 100.0 * (len(hub.nodes()) + 3) / LINES))
    nodes = layout.make_pane(Content("nodes"), share)
    log = layout.make_pane(Content("log"), 100.0 - share)
    left = Split("rows", [nodes, log], 52.0)
    turtle = layout.make_pane(Content("turtle"), 48.0)
    layout.current = layout.open("home", Split("columns", [left, turtle]) if _draws(hub) else left)
    layout.window.focus(turtle.number if _draws(hub) else nodes.number)


def _draws(hub: Hub) -> bool:
    """Whether a node of the graph is turtlesim."""
    rows = hub.supervision.nodes.values() if hub.supervision is not None else ()
    return any("turtlesim" in row["class"].lower() for row in rows)
