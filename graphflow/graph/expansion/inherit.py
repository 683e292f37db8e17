"""Inheritance of nodes from their templates and from the groups around them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from graphflow.errors import Place
from graphflow.graph.checks.validation import Problems, unknown_key
from graphflow.graph.model import FROM_GROUPS, NodeSpec, keys_of
from graphflow.markup.source import Data
from graphflow.markup.tree import Item, first_of, items, merged
from graphflow.names import did_you_mean

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
    files = [file for group in reversed(groups) if "params_file" in group for file in items(group["params_file"])]
    if files:
        entries[f"params_file{FROM_GROUPS}"] = Item(files, item.place)
    return item.with_value(entries)


def from_template(
    item: Item, place: Place, name: Data, templates: Mapping[str, Item], problems: Problems
) -> Item | None:
    """Merge a node with its template; None, with a problem added, if there is no such template.

    Args:
        place, name: Those of the value under `template:`.
    """
    base = templates.get(name) if isinstance(name, str) else None
    if isinstance(name, (list, dict)) or name is None:
        way = f"; write template: {name[0]}" if isinstance(name, list) and len(name) == 1 else ""
        shown_value = "nothing" if name is None else repr(name)
        problems.add(place, f"template: expected the name of one template, got {shown_value}{way}")
        return None
    if base is None:
        near = did_you_mean(str(name), templates) or "; the file has none under templates:"
        problems.add(place, f"there is no template {name!r}{near}")
        return None
    if not isinstance(base.value, dict):
        problems.add(base.place, f"templates.{name}: expected a mapping, as for a node, got {base.plain()!r}")
        return None
    for key, entry in base.entries.items():
        if key == "template":
            problems.add(entry.at, "a template cannot use a template; write here what it has")
        elif key not in keys_of(NodeSpec):
            problems.add(entry.at, unknown_key(key, keys_of(NodeSpec)))
    return merged(base, item, BY_ENTRY)
