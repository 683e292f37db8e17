"""The default first window: the nodes, their details and, if the graph has one, the turtle or the robot."""

from __future__ import annotations

from shutil import get_terminal_size

from graphflow.tui.feeds.hub import Hub
from graphflow.tui.layout import Layout
from graphflow.tui.panes import Content, Split

MANY, WIDE = 16, 110
"""Number of nodes from which their list takes the whole height, given a terminal of at least that many columns."""
LINES = 24
"""Lines of a small terminal, from which the share of the list of nodes is computed."""


_DRAWN = {"turtlesim": "turtle", "robotsimulator": "map"}
"""The views that draw what a node simulates, by a word in the name of its class."""


def open_home(layout: Layout, hub: Hub, columns: int | None = None) -> None:
    """Open the default first window. The turtle or robot gets the focus, so that the arrow keys drive it.

    Args:
        columns: The width of the terminal; None to read it.
    """
    width = get_terminal_size().columns if columns is None else columns
    drawn = _drawn(hub)
    if len(hub.nodes()) > MANY and width >= WIDE and not drawn:
        many, beside = layout.make_pane(Content("nodes"), 60.0), layout.make_pane(Content("detail"), 40.0)
        layout.current = layout.open("home", Split("columns", [many, beside]))
        layout.window.focus(many.number)
        return
    share = min(75.0, max(25.0, 100.0 * (len(hub.nodes()) + 3) / LINES))
    nodes = layout.make_pane(Content("nodes"), share)
    detail = layout.make_pane(Content("detail"), 100.0 - share)
    left = Split("rows", [nodes, detail], 52.0)
    if drawn:
        picture = layout.make_pane(Content(drawn), 48.0)
        layout.current = layout.open("home", Split("columns", [left, picture]))
        layout.window.focus(picture.number)
    else:
        layout.current = layout.open("home", left)
        layout.window.focus(nodes.number)


def _drawn(hub: Hub) -> str:
    """Return the view that draws what a node of the graph simulates; "" if none does."""
    rows = hub.supervision.nodes.values() if hub.supervision is not None else ()
    classes = [row["class"].lower() for row in rows]
    return next((view for word, view in _DRAWN.items() if any(word in cls for cls in classes)), "")
