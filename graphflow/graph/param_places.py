"""Places of the parameters that a graph gives to a program, which gets only their values on its command line.

They are for the program's error messages, and travel in its environment.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

from graphflow.graph.plan import PlannedNode

VARIABLE = "GRAPHFLOW_PARAM_PLACES"
"""Variable with the places by parameter, as JSON, each after the value that is set there."""
_MAX = 32_000
"""Longest text of the variable; the kernel refuses much longer ones."""


def variable(node: PlannedNode) -> dict[str, str]:
    """Return the variable for a node's program; empty for a class, whose values are checked at their places."""
    if not node.executable or not node.params:
        return {}
    places = {
        name: [setting.value, f"{os.path.abspath(setting.place.file)}:{setting.place.line}"]
        for name, setting in node.params.items()
        if setting.place.file
    }
    text = json.dumps(places, default=str)
    return {VARIABLE: text} if len(text) <= _MAX else {}


def place_of(name: str, value: object, environment: Mapping[str, str]) -> str | None:
    """Return where a graph sets a parameter of this program, as `file:line`; None if it does not set this value."""
    if VARIABLE not in environment:
        return None
    try:
        places: Any = json.loads(environment[VARIABLE])
        given, place = places[name]
    except (ValueError, LookupError, TypeError):  # it is of another program, or none of ours
        return None
    return place if given == value and isinstance(place, str) else None
