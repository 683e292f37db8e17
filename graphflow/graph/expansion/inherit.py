"""Inheritance of nodes from the groups around them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from graphflow.graph.model import FROM_GROUPS
from graphflow.markup.tree import Item, first_of

BY_ENTRY = ("params", "remap", "env")
"""Keys that templates, groups and overrides change entry by entry; they replace any other as a whole."""
INHERITED = ("restart", "on_exit", "critical", "log_level", "lifecycle")
"""Keys of a group that a node inherits unless it sets them."""


def after_groups(item: Item, groups: Sequence[Mapping[str, Item]]) -> Item:
    """Add the predecessors of the groups around a node or step to its own."""
    afters = [entries["after"] for entries in (item.entries, *groups) if "after" in entries]
    if not afters or afters == [item.entries.get("after")]:
        return item
    names = {name: word for after in afters for name, word in _names(after).items()}
    return item.with_value({**item.entries, "after": Item(names, afters[0].place, afters[0].key)})


def _names(after: Item) -> dict[str, Item]:
    """Return the predecessors with their conditions; an empty text is the default condition."""
    if isinstance(after.value, dict):
        return after.value
    words = after.value if isinstance(after.value, list) else [after]
    return {str(word.value): Item("", word.place) for word in words}


def with_groups(item: Item, groups: Sequence[Mapping[str, Item]]) -> Item:
    """Add to a node what it inherits from the groups around it.

    Args:
        groups: The settings of the groups, the innermost first.
    """
    entries = dict(after_groups(item, groups).entries)
    for key in INHERITED:
        found = first_of([entries, *groups]).get(key)
        if found is not None and (key != "lifecycle" or "exec" not in entries):  # only some programs have a life cycle
            entries[key] = found
    for key in BY_ENTRY:
        of_groups = first_of([group[key].entries for group in groups if key in group])
        if not of_groups:
            continue
        if key == "env":
            own = entries.get("env", Item({}, item.place))
            entries["env"] = own.with_value(first_of([own.entries, of_groups]))
        else:
            entries[f"{key}{FROM_GROUPS}"] = Item(of_groups, item.place)
    return item.with_value(entries)
