"""The extent of a message type with its nested types; types of unbounded size are refused.

Twenty definitions of two fields each, each nested in the next, make a million fields: sizes multiply, and the texts do
not show it.
"""

from __future__ import annotations

from typing import NamedTuple

from graphflow.errors import InterfaceError
from graphflow.wire.typehash import Lookup

DEPTH_BOUND = 50
"""Deepest nesting of types: code for types recurses once for each level."""


class Extent(NamedTuple):
    """The extent of a type."""

    depth: int
    """Levels of nesting, the type itself included."""
    fields: int
    """Number of fields with those of nested types, counted wherever they are used: code is written for all of them."""
    values: int
    """Number of values in an empty message, which contains its arrays of fixed size."""


def extent(name: str, lookup: Lookup) -> Extent:
    """Return the extent of a message type.

    Raises:
        InterfaceError: It contains itself, or is nested deeper than `DEPTH_BOUND`.
    """
    known: dict[str, Extent] = {}

    def of(type_: str, chain: tuple[str, ...]) -> Extent:
        if type_ in chain:
            raise InterfaceError(f"a message cannot contain itself: {' in '.join([type_, *reversed(chain)])}")
        if type_ not in known:
            depth = fields = values = 0
            # Before its fields are read: the recursion here must not go as deep as a foreign definition does.
            if len(chain) >= DEPTH_BOUND:
                raise _too_deep(name)
            for field in lookup(type_).fields:
                inner = Extent(0, 0, 1) if field.type.is_primitive else of(field.type.base, (*chain, type_))
                depth = max(depth, inner.depth)
                fields += 1 + inner.fields
                values += inner.values * (field.type.size if field.type.array == "fixed" else 1)
            known[type_] = Extent(depth + 1, fields, max(values, 1))
        if len(chain) + known[type_].depth > DEPTH_BOUND:
            raise _too_deep(name)
        return known[type_]

    return of(name, ())


def _too_deep(name: str) -> InterfaceError:
    return InterfaceError(f"{name}: more than {DEPTH_BOUND} levels of nested types; define it with fewer")
