"""The console: a Textual client of a graph, opened by `main`. Packages that add views import three names from here.

from graphflow.tui import Action, TopicMonitor, View
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from graphflow.tui.commands.actions import Action
    from graphflow.tui.feeds.topic_monitor import TopicMonitor
    from graphflow.tui.view import View

__all__ = ["Action", "TopicMonitor", "View"]
_HOMES = {
    "Action": "graphflow.tui.commands.actions",
    "TopicMonitor": "graphflow.tui.feeds.topic_monitor",
    "View": "graphflow.tui.view",
}


def __getattr__(name: str) -> object:
    # Imported when first used: `main` has to set up Textual before it is imported.
    if name not in __all__:
        raise AttributeError(f"module 'graphflow.tui' has no attribute {name!r}")
    from importlib import import_module

    value: object = getattr(import_module(_HOMES[name]), name)
    return value
