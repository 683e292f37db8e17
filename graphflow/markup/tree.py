"""A file's values as a tree of items, each with its place: the form in which blocks are moved and merged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeAlias

from graphflow.errors import Place
from graphflow.markup import source
from graphflow.markup.source import Data, Scalar, Source

Value: TypeAlias = "Scalar | list[Item] | dict[str, Item]"
"""The value of an item: a scalar, or a list or mapping of items."""


class Item(NamedTuple):
    """A value and its place in a file."""

    value: Value
    place: Place
    key: Place | None = None
    """The place of its key in the mapping around it."""

    @property
    def entries(self) -> dict[str, Item]:
        """The entries of a mapping; empty for any other value."""
        return self.value if isinstance(self.value, dict) else {}

    @property
    def items(self) -> list[Item]:
        """The items of a list; empty for any other value."""
        return self.value if isinstance(self.value, list) else []

    @property
    def at(self) -> Place:
        """The place at which it begins: that of its key, if it has one."""
        return self.key or self.place

    def plain(self) -> Data:
        """Return the value without places."""
        if isinstance(self.value, dict):
            return {key: item.plain() for key, item in self.value.items()}
        return [item.plain() for item in self.value] if isinstance(self.value, list) else self.value

    def with_value(self, value: Value) -> Item:
        """Return an item at the same place with another value."""
        return Item(value, self.place, self.key)

    def with_key(self, key: Place | None) -> Item:
        """Return the same value under a key at another place."""
        return Item(self.value, self.place, key)

    def without(self, *keys: str) -> Item:
        """Return a mapping without some of its entries; any other value unchanged."""
        if not isinstance(self.value, dict):
            return self
        return self.with_value({key: item for key, item in self.value.items() if key not in keys})


def tree(src: Source) -> Item:
    """Convert the values of a file to an item."""

    def item(value: Data, path: source.Path) -> Item:
        inner: Value
        if isinstance(value, dict):
            inner = {key: item(entry, (*path, key)) for key, entry in value.items()}
        elif isinstance(value, list):
            inner = [item(entry, (*path, i)) for i, entry in enumerate(value)]
        else:
            inner = value
        return Item(inner, src.place(path), src.keys.get(path))

    return item(src.data, ())


def source_of(top: Item) -> Source:
    """Convert an item back to values and places, as `source.read` returns them."""
    places: dict[source.Path, Place] = {}
    keys: dict[source.Path, Place] = {}

    def data(item: Item, path: source.Path) -> Data:
        places[path] = item.place
        if item.key is not None:
            keys[path] = item.key
        if isinstance(item.value, dict):
            return {key: data(inner, (*path, key)) for key, inner in item.value.items()}
        if isinstance(item.value, list):
            return [data(inner, (*path, i)) for i, inner in enumerate(item.value)]
        return item.value

    return Source(data(top, ()), places, keys)


def located(value: Data, place: Place) -> Item:
    """Convert a plain value to an item whose parts all have one place."""
    if isinstance(value, dict):
        return Item({key: located(inner, place).with_key(place) for key, inner in value.items()}, place)
    if isinstance(value, (list, tuple)):
        return Item([located(inner, place) for inner in value], place)
    return Item(value, place)


def items(item: Item | None) -> list[Item]:
    """Return the items of a list; any other value counts as its only item."""
    if item is None:
        return []
    return item.value if isinstance(item.value, list) else [item]


def merged(base: Item, over: Item, by_entry: tuple[str, ...] = ()) -> Item:
    """Merge two mappings; the entries of `over` replace those of `base`.

    Args:
        by_entry: Keys of inner mappings that are merged in the same way, not replaced as a whole.
    """
    entries = dict(base.entries)
    for key, item in over.entries.items():
        old = entries.get(key)
        if key in by_entry and old is not None and isinstance(old.value, dict) and isinstance(item.value, dict):
            item = item.with_value({**old.value, **item.value})
        entries[key] = item
    return over.with_value(entries)


def first_of(mappings: list[Mapping[str, Item]]) -> dict[str, Item]:
    """Merge mappings in order; the first entry under a key wins."""
    found: dict[str, Item] = {}
    for mapping in mappings:
        for key, item in mapping.items():
            found.setdefault(key, item)
    return found


def shared(key: str, mappings: Sequence[Mapping[str, Item]]) -> dict[str, Data]:
    """Merge the plain entries that mappings have under one key; the first entry under a name wins."""
    found = first_of([mapping[key].entries for mapping in mappings if key in mapping])
    return {name: item.plain() for name, item in found.items()}
