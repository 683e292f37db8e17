"""The default first window: the nodes, their details and, if the graph has one, the turtle."""

from __future__ import annotations

from shutil import get_terminal_size

from graphflow.tui.feeds.hub import Hub
from graphflow.tui.layout import Layout
from graphflow.tui.panes import Content, Split

MANY, WIDE = 16, 110
"""Number of nodes from which their list takes the whole height, given a terminal of at least that many columns."""
LINES = 24
"""Lines of a small terminal, from which the share of the list of nodes is computed."""


def open_home(layout: Layout, hub: Hub, columns: int | None = None) -> None:
    """Open the default first window. A turtle gets the focus, so that the arrow keys drive it.

    Args:
        columns: The width of the terminal; None to read it.
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
    """Return whether a node of the graph is turtlesim."""
    rows = hub.supervision.nodes.values() if hub.supervision is not None else ()
    return any("turtlesim" in row["class"].lower() for row in rows)
