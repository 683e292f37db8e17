"""Completions of a command line's arguments: live names by the argument's name, and messages."""

from __future__ import annotations

from collections.abc import Sequence

from graphflow.errors import GraphflowError
from graphflow.machines.cache import GraphCache

MESSAGES = ("VALUES", "GOAL", "REQUEST")
"""Arguments that are messages, whose type is the second argument."""


def names_for(place: str, given: Sequence[str], cache: GraphCache) -> list[str]:
    """Return the names that complete an argument; none for an argument of another kind.

    Args:
        place: The argument's name, such as `TOPIC`.
        given: The arguments before it.
    """
    match place.upper():
        case "NODE" | "NODES":
            return list(cache.nodes(hidden=False))
        case "TOPIC" | "TOPICS":
            return list(cache.topics())
        case "SERVICE":
            return list(cache.services())
        case "ACTION":
            return list(cache.actions())
        case "TYPE" if given:
            tables = (cache.topics(hidden=True), cache.services(hidden=True), cache.actions())
            return [type_ for table in tables for type_ in table.get(given[0], [])]
        case _:
            return []


def message(type_name: str, mark: str = "'") -> list[str]:
    """Return a quoted message with all its fields, to be filled in; nothing if there is no such type."""
    from graphflow.introspect.messages.echo import flow, plain
    from graphflow.msgs import registry

    try:
        return [f"{mark}{flow(plain(registry.prototype(registry.full_name(type_name))))}{mark}"]
    except GraphflowError:
        return []
