"""Conversion of nodes given as ROS's pairs of package and executable to classes."""

from __future__ import annotations

from pathlib import Path

from graphflow.markup.tree import Item
from graphflow.workspace.executables import find


def as_class(node: Item, root: Path) -> Item:
    """Replace `pkg` and `exec` of a node by its class, if they name one; any other node is returned unchanged.

    Args:
        root: The project's folder.
    """
    package, name = node.entries.get("pkg"), node.entries.get("exec")
    if package is None or name is None or not isinstance(package.value, str) or not isinstance(name.value, str):
        return node
    found = find(package.value, name.value, root)
    if found is None or "class" in node.entries:  # having both is refused later
        return node
    others = node.without("pkg", "exec", *(["lifecycle"] if found.is_always_active else []))
    return node.with_value({"class": Item(found.class_path, name.place, name.key), **others.entries})
