"""Edits of graph files that keep comments and order."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from io import StringIO
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap
from ruamel.yaml.error import YAMLError

from graphflow.errors import GraphFileError, Place, Problem
from graphflow.graph.plan import Plan
from graphflow.interface import GroupChange
from graphflow.machines.regrouping import plain
from graphflow.reading import found_text

KeyPath = tuple[str, ...]
"""The keys that lead to a node's mapping: `("nodes", "/turtle1/follower")`, or below `override`."""
_WIDTH = 4096
"""Line length in characters, long enough that no line is wrapped."""


def node_paths(plan: Plan, nodes: set[str], folder: Path) -> dict[str, KeyPath]:
    """Find the keys of nodes in the graph's own file: under `nodes`, or under `override` for included nodes.

    Args:
        folder: The folder to which the plan's file names are relative.

    Raises:
        GraphFileError: A node is not at its place in the plan: the file has changed meanwhile.
    """
    top = (folder / plan.file).resolve()
    found: dict[str, KeyPath] = {}
    for node in plan.nodes:
        if node.name in nodes:
            file = (folder / node.place.file).resolve()
            key = _key_at(file, node.place)
            if file != top and not isinstance(_load(found_text(top), plan.file).get("include"), str):
                text = (
                    f"{node.name} comes from here, which {plan.file} includes in a block; write it under that override:"
                )
                raise GraphFileError([Problem(node.place, text)])
            found[node.name] = ("nodes" if file == top else "override", key)
    return found


def _key_at(file: Path, place: Place) -> str:
    """Return the key of `nodes` or `override` on a line."""
    data = _load(found_text(file), str(file))
    for section in ("nodes", "override"):
        nodes = data.get(section)
        if isinstance(nodes, CommentedMap):
            for key in nodes:
                if nodes.lc.key(key)[0] + 1 == place.line:
                    return str(key)
    text = "the node is not on this line any more; was the file changed? Restart the graph"
    if place.line in _key_lines([data.get("group"), data.get("for")]):
        text = "the node is written in a group or loop, where it is changed by hand"
    raise GraphFileError([Problem(place, text)])


def _key_lines(data: object) -> set[int]:
    """Return the lines with keys."""
    if isinstance(data, list):
        return {line for item in data for line in _key_lines(item)}
    if not isinstance(data, CommentedMap):
        return set()
    return {data.lc.key(key)[0] + 1 for key in data} | {n for item in data.values() for n in _key_lines(item)}


def with_group(
    text: str,
    path: KeyPath,
    group: str,
    handlers: Sequence[str],
    inherited: Mapping[str, GroupChange] = MappingProxyType({}),
    settings: Mapping[str, object] = MappingProxyType({}),
) -> str:
    """Move handlers of a node to one of its groups.

    Args:
        inherited: The groups of the node in an included file, which this file would replace as a whole.
        settings: Other settings of the group: its `limit`, `thread`.
    """

    def change(node: CommentedMap) -> None:
        base = {} if "concurrency" in node else inherited
        groups = _below(node, "concurrency")
        for name, of_base in base.items():
            groups[name] = _flow(plain(of_base))
        for other in groups:
            if other != group:
                _remove(groups[other], handlers)
        _add(groups, group, handlers)
        if settings:
            members = groups[group]
            if not isinstance(members, CommentedMap):
                members = groups[group] = _flow({"handlers": members} if members else {})
            members.update(settings)

    return _changed(text, path, change)


def _remove(members: object, handlers: Sequence[str]) -> None:
    """Remove handlers from a group, which is a mapping or a list of handlers."""
    listed = members.get("handlers") if isinstance(members, CommentedMap) else members
    if isinstance(listed, list):
        for handler in handlers:
            while handler in listed:
                listed.remove(handler)


def _add(groups: CommentedMap, group: str, handlers: Sequence[str]) -> None:
    """Add handlers to a group, which may be new."""
    present = groups.get(group)
    if isinstance(present, CommentedMap):
        if handlers:
            listed = present.setdefault("handlers", [])
            listed.extend(h for h in handlers if h not in listed)
    elif isinstance(present, list):
        present.extend(h for h in handlers if h not in present)
    else:
        groups[group] = _flow_list(handlers)


def with_params(text: str, path: KeyPath, values: Mapping[str, object]) -> str:
    """Set parameters of a node."""

    def change(node: CommentedMap) -> None:
        params = _below(node, "params")
        for name, value in values.items():
            params[name] = _flow_list(value) if isinstance(value, (list, tuple)) else value

    return _changed(text, path, change)


def with_console(text: str, section: Mapping[str, Any]) -> str:
    """Replace the windows of the `console:` section, and keep its other settings."""
    data = _load(text, "the graph file")
    console = data.get("console")
    if not isinstance(console, CommentedMap):
        console = data["console"] = CommentedMap()
    windows = []
    for window in section["windows"]:
        made = CommentedMap(name=window["name"], panes=_flow(window["panes"]))
        windows.append(made)
    console["windows"] = windows
    return _dump(data, text)


def _changed(text: str, path: KeyPath, change: Callable[[CommentedMap], None]) -> str:
    data = _load(text, "the graph file")
    node = data
    for key in path:
        if not isinstance(node.get(key), CommentedMap):
            node[key] = CommentedMap()
        node = node[key]
    change(node)
    return _dump(data, text)


def _below(node: CommentedMap, key: str) -> CommentedMap:
    if not isinstance(node.get(key), CommentedMap):
        node[key] = CommentedMap()
        node[key].fa.set_flow_style()
    found: CommentedMap = node[key]
    return found


def _flow_list(values: Iterable[object]) -> object:
    return _flow(list(values))


def _flow(value: object) -> Any:
    """Convert plain data to ruamel.yaml's types in flow style, which it writes on one line."""
    from ruamel.yaml.comments import CommentedSeq

    if isinstance(value, dict):
        made = CommentedMap({k: _flow(v) for k, v in value.items()})
        made.fa.set_flow_style()
        return made
    if isinstance(value, (list, tuple)):
        listed = CommentedSeq([_flow(v) for v in value])
        listed.fa.set_flow_style()
        return listed
    return value


def _yaml(text: str) -> YAML:
    yaml = YAML()
    yaml.preserve_quotes = True
    # ruamel.yaml would write [{a: 1}] as [a: 1].
    yaml.brace_single_entry_mapping_in_flow_sequence = True
    yaml.width = _WIDTH
    indent = _indent(text)
    yaml.indent(mapping=indent, sequence=indent + 2, offset=indent)
    return yaml


def _indent(text: str) -> int:
    """Return the width of the first indentation in the file."""
    for line in text.split("\n"):
        bare = line.lstrip(" ")
        if bare and not bare.startswith(("#", "-")) and len(bare) < len(line):
            return len(line) - len(bare)
    return 2


def _load(text: str, name: str) -> CommentedMap:
    try:
        data = _yaml(text).load(text)
    except YAMLError as error:
        raise GraphFileError([Problem(Place(name), f"not YAML any more: {error}")]) from None
    if not isinstance(data, CommentedMap):
        raise GraphFileError([Problem(Place(name), "not a graph file any more: it holds no mapping")])
    return data


def _dump(data: CommentedMap, text: str) -> str:
    out = StringIO()
    _yaml(text).dump(data, out)
    return out.getvalue()
