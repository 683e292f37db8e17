"""The body of a graph file or group, as the conversion of a launch file adds to it: nodes, steps, groups, includes."""

from __future__ import annotations

from graphflow.markup.tree import Item


def extend(body: dict[str, Item], key: str, more: Item) -> None:
    """Add the entries of another body under a key."""
    if key in ("nodes", "steps"):
        for name, entry in more.entries.items():
            put(body, key, name, entry)
    else:
        for block in more.value if isinstance(more.value, list) else [more]:
            add(body, key, block)


def put(body: dict[str, Item], section: str, key: str, item: Item) -> None:
    """Add an entry to a section of a body; a second one with the same key goes into a group of its own."""
    old = body.get(section, Item({}, item.place, item.at))
    if key in old.entries:  # real duplicates are reported once all names are resolved
        add(body, "group", Item({section: Item({key: item}, item.place)}, item.place))
    else:
        body[section] = old.with_value({**old.entries, key: item})


def add(body: dict[str, Item], key: str, item: Item) -> None:
    """Add a block to those under a key."""
    old = body.get(key)
    if old is None:
        body[key] = item
    elif isinstance(old.value, list):
        body[key] = old.with_value([*old.value, item])
    else:
        body[key] = Item([old, item], old.place, old.key)
