"""The console: a Textual client of a graph, opened by `main`. Packages that add views need three names from here.

from graphflow.tui import Action, Tap, View
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from graphflow.tui.actions import Action
    from graphflow.tui.tap import Tap
    from graphflow.tui.view import View

__all__ = ["Action", "Tap", "View"]


def __getattr__(name: str) -> object:
    # Imported when first used: `main` has to set up Textual before it is imported.
    if name not in __all__:
        raise AttributeError(f"module 'graphflow.tui' has no attribute {name!r}")
    from importlib import import_module

    module = import_module(f"graphflow.tui.{'actions' if name == 'Action' else name.lower()}")
    value: object = getattr(module, name)
    return value
