"""The views of the console by name, and the arguments of each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple


class ViewForm(NamedTuple):
    """The arguments of a view."""

    about: str = ""
    """The kind of its subject; empty for a view of everything."""
    needs_it: bool = False
    """Whether the subject is required."""
    options: tuple[str, ...] = ()


VIEWS: Mapping[str, ViewForm] = {
    "nodes": ViewForm(options=("by", "order", "find")),
    "detail": ViewForm(options=("tab",)),
    "log": ViewForm("node or namespace", options=("level", "filter", "follow", "wrap")),
    "topics": ViewForm("node"),
    "echo": ViewForm("topic", needs_it=True),
    "hz": ViewForm("topic", needs_it=True),
    "plot": ViewForm("topic.field", needs_it=True, options=("seconds", "axes")),
    "graph": ViewForm("namespace"),
    "tree": ViewForm("node", options=("find",)),
    "calls": ViewForm("service"),
    "goals": ViewForm("action"),
    "params": ViewForm("node"),
    "groups": ViewForm("node"),
    "turtle": ViewForm("turtle"),
    "map": ViewForm("topic"),
    "tf": ViewForm("frame"),
    "scan": ViewForm("topic"),
    "image": ViewForm("topic"),
    "joints": ViewForm("topic"),
    "source": ViewForm("file:line", needs_it=True),
    "crash": ViewForm("node", needs_it=True),
    "top": ViewForm(),
    "prompt": ViewForm("command", options=("run",)),
    "help": ViewForm(),
}
"""The views that come with graphflow. `tests/tui` checks this table against the console."""

PLUGINS = "graphflow.views"
"""The entry point group by which other packages add views."""


def known_views() -> list[str]:
    """Return the names of graphflow's views, and of those that other installed packages add."""
    from importlib.metadata import entry_points

    return [*VIEWS, *sorted({e.name for e in entry_points(group=PLUGINS)} - set(VIEWS))]
