"""Panes of the console that name nodes, topics or fields which the graph does not have.

A pane may also show what other graphs have, so only what looks like a slip is reported.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping

from graphflow.console.subjects import Subject
from graphflow.errors import GraphflowError, Problem
from graphflow.names import did_you_mean, nearest
from graphflow.wire.schema import Message

_CUTOFF = 0.8
"""Similarity from which a name counts as misspelt."""
_ELEMENTS = re.compile(r"\[\d*\]")


def odd_panes(subjects: Iterable[Subject], known: Mapping[str, Mapping[str, str]]) -> Iterator[tuple[str, Problem]]:
    """Yield the names of a graph that panes misspell, each with a remark.

    Args:
        known: By kind (node, topic, service, action), the names in the graph, each with its type or an empty text.
    """
    for subject in subjects:
        kind, _, rest = subject.kind.partition(" or ")
        kind, _, field = kind.partition(".")
        if kind not in known:
            continue
        name, _, fields = subject.text.partition(".") if field else (subject.text, "", "")
        if name in known[kind]:
            for one in fields.split(",") if fields and known[kind][name] else ():
                if fault := _field_fault(one, known[kind][name]):
                    yield name, Problem(subject.place, f"{name} has {fault}")
        elif not _is_inside(name, known[kind], holds_nodes=bool(rest)) and (near := _meant(name, known[kind])):
            yield name, Problem(subject.place, f"this graph has no {kind} {name}; did you mean {near!r}?")


def _is_inside(name: str, known: Collection[str], *, holds_nodes: bool) -> bool:
    """Return whether a name is one below a known one, such as an action's status, or the namespace of some."""
    inside = any(name.startswith(f"{other}/") for other in known)
    return inside or (holds_nodes and any(other.startswith(f"{name.rstrip('/')}/") for other in known))


def _meant(name: str, known: Collection[str]) -> str:
    """Return the known name that another may be a slip for; empty if there is none, or if only digits differ."""
    if f"/{name}" in known:
        return f"/{name}"
    found = nearest(name, known, cutoff=_CUTOFF) or ""
    return "" if re.sub(r"\d", "", found) == re.sub(r"\d", "", name) else found


def _field_fault(path: str, type_name: str) -> str:
    """Return why a type has no such field; empty if it has one, or if the type is not known here."""
    from graphflow.msgs import registry

    try:
        schema: Message | None = registry.message_schema(registry.full_name(type_name))
        for part in _ELEMENTS.sub("", path).split("."):
            if schema is None:
                return ""
            types = {field.name: field.type for field in schema.fields}
            if part not in types:
                return f"no field {part!r}{did_you_mean(part, types)}"
            schema = None if types[part].is_primitive else registry.message_schema(types[part].base)
    except GraphflowError:
        return ""
    return ""
