"""Type definitions in bags: the text of a type, then those of its nested types, each after a line of `=`.

Source: MCAP's registry of schema encodings, `ros2msg`.
"""

from __future__ import annotations

from collections.abc import Mapping

from graphflow.errors import InterfaceError
from graphflow.introspect.messages.definitions import asked_sources
from graphflow.msgs import registry
from graphflow.runtime.node import Node
from graphflow.wire.liveliness import Entity
from graphflow.wire.schema import Message
from graphflow.wire.typehash import referenced

RULE = "=" * 80


def joined(name: str, sources: Mapping[str, str]) -> str:
    """Join the texts of a type and its nested types.

    Args:
        name: `package/msg/Name`.
        sources: Texts of definition files by type, `name` included.
    """
    others = [
        f"{RULE}\nMSG: {_short(other)}\n{_ended(text)}" for other, text in sorted(sources.items()) if other != name
    ]
    return _ended(sources[name]) + "".join(others)


def parted(name: str, text: str) -> dict[str, str]:
    """Split a definition into the texts of a type and its nested types, by type.

    Raises:
        InterfaceError: It is not in this form.
    """
    first, *others = text.split(f"{RULE}\n")
    found = {name: first}
    for other in others:
        head, _, body = other.partition("\n")
        marker, _, short = head.partition(" ")
        parts = short.strip().split("/")
        if marker != "MSG:" or len(parts) not in (2, 3):
            raise InterfaceError(f"the definition of {name} has a part that begins {head[:40]!r}")
        found[f"{parts[0]}/msg/{parts[-1]}"] = body
    return found


def known(name: str) -> str:
    """Return the definition of a message type that is known here, a service's request included.

    Raises:
        InterfaceError: It is not known here.
    """
    message = registry.message_schema(name)
    sources = {one: registry.definition(one) for one in referenced(message, registry.message_schema)}
    sources[name] = registry.definition(name) if "/msg/" in name else _written(message)
    return joined(name, sources)


async def fetch(node: Node, entity: Entity) -> str:
    """Return the definition of a topic's type: the local one if it is the same, else its publishers are queried.

    Args:
        entity: A publisher of the topic.

    Returns:
        The text; empty for a part of a service or action, such as its events: it follows from a type that has a file.

    Raises:
        InterfaceError: No process returns a definition with that hash.
    """
    if "_" in entity.type.rpartition("/")[2] and "/msg/" not in entity.type:
        return ""
    try:
        if not entity.hash or registry.hash_of(entity.type) == entity.hash:
            return known(entity.type)
    except InterfaceError as error:
        unknown = error
    else:
        unknown = InterfaceError("its definition here differs")
    try:
        return joined(entity.type, await asked_sources(node, entity))
    except InterfaceError as error:
        raise InterfaceError(f"{unknown}; {error}") from None


def _written(message: Message) -> str:
    """Return the text of a part of a service, which has no file of its own."""
    constants = [f"{c.type} {c.name}={c.value}\n" for c in message.constants]
    fields = [f"{_short(str(field.type))} {field.name}\n" for field in message.fields]
    return "".join([*constants, *fields])


def _short(name: str) -> str:
    return name.replace("/msg/", "/")


def _ended(text: str) -> str:
    return text if not text or text.endswith("\n") else f"{text}\n"
