"""The definition of a message type as bags have it: its text, then those of the types in it, each after a line of `=`.

Source: MCAP's registry of schema encodings, `ros2msg`.
"""

from __future__ import annotations

from collections.abc import Mapping

from graphflow.errors import InterfaceError
from graphflow.msgs import registry
from graphflow.wire.typehash import referenced

RULE = "=" * 80


def joined(name: str, sources: Mapping[str, str]) -> str:
    """One text of many.

    Args:
        name: `package/msg/Name`.
        sources: Texts of definition files by type, that of `name` among them.
    """
    others = [
        f"{RULE}\nMSG: {_short(other)}\n{_ended(text)}" for other, text in sorted(sources.items()) if other != name
    ]
    return _ended(sources[name]) + "".join(others)


def parted(name: str, text: str) -> dict[str, str]:
    """The texts of a type and of those in it, by type.

    Raises:
        InterfaceError: It is not in this form.
    """
    first, *others = text.split(f"{RULE}\n")
    found = {name: first}
    for other in others:
        head, _, body = other.partition("\n")
        word, _, short = head.partition(" ")
        parts = short.strip().split("/")
        if word != "MSG:" or len(parts) not in (2, 3):
            raise InterfaceError(f"the definition of {name} has a part that begins {head[:40]!r}")
        found[f"{parts[0]}/msg/{parts[-1]}"] = body
    return found


def known(name: str) -> str:
    """The definition of a message type that is known here, in one text; derived types (of services) have none.

    Raises:
        InterfaceError: It is not known here.
    """
    names = [name, *referenced(registry.message_schema(name), registry.message_schema)]
    return joined(name, {one: registry.definition(one) for one in names})


def _short(name: str) -> str:
    return name.replace("/msg/", "/")


def _ended(text: str) -> str:
    return text if not text or text.endswith("\n") else f"{text}\n"
