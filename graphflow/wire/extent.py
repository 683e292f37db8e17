"""The size of a message type together with the types in it: those without an end are refused.

Twenty definitions of two fields each, every one in the one before, are a million fields: sizes multiply, and the texts
do not show it.
"""

from __future__ import annotations

from typing import NamedTuple

from graphflow.errors import InterfaceError
from graphflow.wire.typehash import Lookup

DEPTH_BOUND = 50
"""Types that may be in each other: what handles types calls itself for each."""


class Extent(NamedTuple):
    """The size of a type."""

    depth: int
    """Types in each other, itself included."""
    fields: int
    """Its fields and those of the types in it, each counted wherever it is used: code is written for all of them."""
    values: int
    """Values of an empty message: arrays of fixed size are there in it."""


def extent(name: str, lookup: Lookup) -> Extent:
    """The size of a message type.

    Raises:
        InterfaceError: It contains itself, or more types in each other than `DEPTH_BOUND`.
    """
    known: dict[str, Extent] = {}

    def of(type_: str, chain: tuple[str, ...]) -> Extent:
        if type_ in chain:
            raise InterfaceError(f"a message cannot contain itself: {' in '.join([type_, *reversed(chain)])}")
        if type_ not in known:
            depth = fields = values = 0
            # Before its fields are looked at: nothing here may go as deep as somebody's definitions do.
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
    return InterfaceError(f"{name}: more than {DEPTH_BOUND} types are in each other; define it with fewer levels")
