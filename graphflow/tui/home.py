"""The first window of a console: the nodes, what there is of them and, where there is a turtle, the turtle."""

from __future__ import annotations

from shutil import get_terminal_size

from graphflow.tui.feeds.hub import Hub
from graphflow.tui.layout import Layout
from graphflow.tui.panes import Content, Split

MANY, WIDE = 16, 110
"""Nodes from which on their list has the whole height, in terminals of at least so many columns."""
LINES = 24
"""Lines of a small terminal, by which the list of nodes gets its share."""


def open_home(layout: Layout, hub: Hub, columns: int | None = None) -> None:
    """Open the first window of a graph that says nothing of windows. A turtle has the focus: arrows drive it.

    Args:
        columns: Those of the terminal, for a test; else as it is.
    """
    width = get_terminal_size().columns if columns is None else columns
    if len(hub.nodes()) > MANY and width >= WIDE and not _draws(hub):
        many, beside = layout.make_pane(Content("nodes"), 60.0), layout.make_pane(Content("detail"), 40.0)
        layout.current = layout.open("home", Split("columns", [many, beside]))
        layout.window.focus(many.number)
        return
    share = min(75.0, max(25.0, 100.0 * (len(hub.nodes()) + 3) / LINES))
    nodes = layout.make_pane(Content("nodes"), share)
    detail = layout.make_pane(Content("detail"), 100.0 - share)
    left = Split("rows", [nodes, detail], 52.0)
    turtle = layout.make_pane(Content("turtle"), 48.0)
    layout.current = layout.open("home", Split("columns", [left, turtle]) if _draws(hub) else left)
    layout.window.focus(turtle.number if _draws(hub) else nodes.number)


def _draws(hub: Hub) -> bool:
    """Whether a node of the graph is turtlesim."""
    rows = hub.supervision.nodes.values() if hub.supervision is not None else ()
    return any("turtlesim" in row["class"].lower() for row in rows)
