"""A file's values as a tree of items, each with its place: what blocks of a graph file are moved and merged as."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from graphflow.errors import Place
from graphflow.markup import source
from graphflow.markup.source import Source


class Item(NamedTuple):
    """A value with what is in it, and where it was written."""

    value: Any
    """A scalar, a dictionary of items, or a list of items."""
    place: Place
    key: Place | None = None
    """The place of its key in the mapping that it is in."""

    @property
    def entries(self) -> dict[str, Item]:
        """What a mapping holds; nothing if the value is none."""
        return self.value if isinstance(self.value, dict) else {}

    @property
    def at(self) -> Place:
        """Where it begins: at its key, if it has one."""
        return self.key or self.place

    def plain(self) -> Any:
        """The value without places."""
        if isinstance(self.value, dict):
            return {key: item.plain() for key, item in self.value.items()}
        return [item.plain() for item in self.value] if isinstance(self.value, list) else self.value

    def without(self, *keys: str) -> Item:
        """A mapping without some of its entries; any other value as it is."""
        if not isinstance(self.value, dict):
            return self
        return self._replace(value={key: item for key, item in self.value.items() if key not in keys})


def tree(src: Source) -> Item:
    """What was read from a file, as an item."""

    def item(value: Any, path: source.Path) -> Item:
        if isinstance(value, dict):
            value = {key: item(inner, (*path, key)) for key, inner in value.items()}
        elif isinstance(value, list):
            value = [item(inner, (*path, i)) for i, inner in enumerate(value)]
        return Item(value, src.place(path), src.keys.get(path))

    return item(src.data, ())


def source_of(top: Item) -> Source:
    """The opposite of `tree`."""
    places: dict[source.Path, Place] = {}
    keys: dict[source.Path, Place] = {}

    def data(item: Item, path: source.Path) -> Any:
        places[path] = item.place
        if item.key is not None:
            keys[path] = item.key
        if isinstance(item.value, dict):
            return {key: data(inner, (*path, key)) for key, inner in item.value.items()}
        if isinstance(item.value, list):
            return [data(inner, (*path, i)) for i, inner in enumerate(item.value)]
        return item.value

    return Source(data(top, ()), places, keys)


def located(value: Any, place: Place) -> Item:
    """A plain value, all of which was written at one place."""
    if isinstance(value, dict):
        return Item({key: located(inner, place)._replace(key=place) for key, inner in value.items()}, place)
    if isinstance(value, (list, tuple)):
        return Item([located(inner, place) for inner in value], place)
    return Item(value, place)


def merged(base: Item, over: Item, by_entry: tuple[str, ...] = ()) -> Item:
    """A mapping over another.

    Args:
        by_entry: Entries that are mappings themselves and are merged in the same way, not replaced as a whole.
    """
    entries = dict(base.entries)
    for key, item in over.entries.items():
        old = entries.get(key)
        if key in by_entry and old is not None and isinstance(old.value, dict) and isinstance(item.value, dict):
            item = item._replace(value={**old.value, **item.value})
        entries[key] = item
    return over._replace(value=entries)


def first_of(mappings: list[Mapping[str, Item]]) -> dict[str, Item]:
    """All entries of several mappings; of those with one key the first, and those of the first before the others."""
    found: dict[str, Item] = {}
    for mapping in mappings:
        for key, item in mapping.items():
            found.setdefault(key, item)
    return found


def shared(key: str, mappings: Sequence[Mapping[str, Item]]) -> dict[str, Any]:
    """The plain entries that mappings have under one key; of those with one name that of the first mapping."""
    found = first_of([mapping[key].entries for mapping in mappings if key in mapping])
    return {name: item.plain() for name, item in found.items()}
