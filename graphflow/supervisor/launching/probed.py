"""The answer of a probe, read without importing node classes or the runtime."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from graphflow.errors import Place, Problem
from graphflow.interface import Interface

if TYPE_CHECKING:
    from graphflow.supervisor.processes.messages import InterfacesJson


def read_interfaces(data: InterfacesJson) -> dict[str, Interface | Problem]:
    """Convert the result of `classes.interfaces` to interfaces, or the problem of each class that has none."""
    return {
        path: Problem(Place(""), str(value["problem"])) if "problem" in value else Interface.from_json(value)
        for path, value in data.items()
    }


def slips_in(data: InterfacesJson, regrouped: Collection[str] = ()) -> list[str]:
    """Return the slips in the source of the classes, each once: derived classes repeat those of their base.

    Args:
        regrouped: The classes of which a graph file changes the groups.
    """
    found = [value.get("slips", ()) for value in data.values()]
    found += [value.get("slips_in_groups", ()) for path, value in data.items() if path not in regrouped]
    return list(dict.fromkeys(str(text) for slips in found if isinstance(slips, (list, tuple)) for text in slips))
