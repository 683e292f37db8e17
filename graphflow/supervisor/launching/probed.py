"""The answer of a process that has imported node classes, read where none of them, nor what runs nodes, is imported."""

from __future__ import annotations

from typing import Any

from graphflow.errors import Place, Problem
from graphflow.interface import Interface


def read_interfaces(data: dict[str, Any]) -> dict[str, Any]:
    """What `interfaces` returned, as Interfaces and Problems."""
    return {
        path: Problem(Place(""), value["problem"]) if "problem" in value else Interface.from_json(value)
        for path, value in data.items()
    }


def slips_in(data: dict[str, Any]) -> list[str]:
    """The slips in the source of the classes, each once; a class that is there twice, or derived from, has the same."""
    return list(dict.fromkeys(text for value in data.values() for text in value.get("slips", ())))
