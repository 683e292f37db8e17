"""Nodes of graph files that are written as ROS's pairs of package and executable, as the classes that they are."""

from __future__ import annotations

from pathlib import Path

from graphflow.markup.tree import Item
from graphflow.workspace.executables import find


def as_class(node: Item, root: Path) -> Item:
    """A node of a graph file; one whose `pkg` and `exec` are a class that is here has that class instead.

    Args:
        root: The folder of the project.
    """
    package, name = node.entries.get("pkg"), node.entries.get("exec")
    if package is None or name is None or not isinstance(package.value, str) or not isinstance(name.value, str):
        return node
    found = find(package.value, name.value, root)
    if found is None or "class" in node.entries:  # both is refused later
        return node
    return node.with_value(
        {"class": Item(found.class_path, name.place, name.key), **node.without("pkg", "exec").entries}
    )
