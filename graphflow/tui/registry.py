"""The views by name: graphflow's own, imported when first shown, and those of other packages."""

from __future__ import annotations

from importlib import import_module

from graphflow.console.views import PLUGINS, VIEWS, known_views
from graphflow.names import did_you_mean
from graphflow.tui.view import View

_FOLDERS = {
    "topics": ("topics", "echo", "hz", "plot"),
    "nodes": ("nodes", "detail", "crash", "params", "tree", "top"),
    "robot": ("map", "tf", "scan", "image", "joints"),
}
"""Packages below `views`, with the views in each; other views have a module of their own."""
TOUR = "tour"
"""The view of `graphflow demo`, which no list offers."""


def view_class(name: str) -> type[View]:
    """Return the class of a view, or of a view that explains why it cannot be shown."""
    if name in VIEWS or name == TOUR:
        found: type[View] = import_module(_module(name)).VIEW
        return found
    from importlib.metadata import entry_points

    from graphflow.tui.views.broken import broken

    for entry in entry_points(group=PLUGINS):
        if entry.name == name:
            try:
                loaded = entry.load()
            except Exception as error:  # another package's code may raise anything, and its author must see it
                return broken(f"the view {name} of {entry.value} cannot be loaded: {error!r}")
            if isinstance(loaded, type) and issubclass(loaded, View):
                return loaded
            return broken(f"{entry.value} is no subclass of graphflow.tui.view.View")
    return broken(f"there is no view {name!r}{did_you_mean(name, known_views())}")


def _module(name: str) -> str:
    folder = next((f"{folder}." for folder, names in _FOLDERS.items() if name in names), "")
    return f"graphflow.tui.views.{folder}{name}"


def describe(name: str) -> str:
    """Return the one-line description of a view."""
    return view_class(name).DOC
