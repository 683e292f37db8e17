"""Attributes of actions in ROS's launch files, as readers of them need them."""

from __future__ import annotations

import shlex

from graphflow.graph.tree import Item


def children(item: Item) -> list[Item]:
    """The actions within an action."""
    found = item.entries.get("children")
    return found.value if found is not None and isinstance(found.value, list) else []


def items(item: Item | None) -> list[Item]:
    """A list's items, of which one alone may stand without the list."""
    if item is None:
        return []
    return item.value if isinstance(item.value, list) else [item]


def words(item: Item | None) -> list[str]:
    """The words of a text, or of a list of them."""
    if item is None:
        return []
    if isinstance(item.value, list):
        return [str(word.value) for word in item.value]
    try:
        return shlex.split(str(item.value))
    except ValueError:  # a quote that is not closed
        return str(item.value).split()


def says(item: Item, key: str, *wanted: str) -> bool:
    """Whether an attribute is there and one of some words, in any case."""
    value = item.entries.get(key)
    return value is not None and str(value.value).lower() in wanted
