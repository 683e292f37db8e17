"""What may stand in a place of a command line: live names by the word that the place is called by, and messages."""

from __future__ import annotations

from collections.abc import Sequence

from graphflow.errors import GraphflowError
from graphflow.machines.cache import GraphCache

MESSAGES = ("VALUES", "GOAL", "REQUEST")
"""Places for a message; the type was named second."""


def names_for(place: str, given: Sequence[str], cache: GraphCache) -> list[str]:
    """The names that a place may have; none for a place of another kind.

    Args:
        place: The name of an argument, such as `TOPIC`.
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
    """A message with all its fields, between quotation marks, to be filled in; none if there is no such type."""
    from graphflow.introspect.messages.echo import flow, plain
    from graphflow.msgs import registry

    try:
        return [f"{mark}{flow(plain(registry.prototype(registry.full_name(type_name))))}{mark}"]
    except GraphflowError:
        return []
