"""Changing a graph file: a new text from the old one, in which comments and order are kept."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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

KeyPath = tuple[str, ...]
"""Where a node's mapping is in a file: `("nodes", "/turtle1/follower")`, or below `override`."""
_WIDTH = 4096
"""Characters of a line: long ones are left as they are."""


def node_paths(plan: Plan, nodes: set[str], folder: Path) -> dict[str, KeyPath]:
    """Where nodes can be changed in the graph's own file: where they are written or, if included, under `override`.

    Args:
        folder: What the plan's file names are relative to.

    Raises:
        GraphFileError: A node is not where the plan says: the file has been changed meanwhile.
    """
    top = (folder / plan.file).resolve()
    found: dict[str, KeyPath] = {}
    for node in plan.nodes:
        if node.name in nodes:
            file = (folder / node.place.file).resolve()
            key = _key_at(file, node.place)
            if file != top and not isinstance(_load(top.read_text(encoding="utf-8"), plan.file).get("include"), str):
                text = (
                    f"{node.name} comes from here, which {plan.file} includes in a block; write it under that override:"
                )
                raise GraphFileError([Problem(node.place, text)])
            found[node.name] = ("nodes" if file == top else "override", key)
    return found


def _key_at(file: Path, place: Place) -> str:
    """The key of `nodes`, or of `override`, that stands on a line."""
    data = _load(file.read_text(encoding="utf-8"), str(file))
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


def _key_lines(data: Any) -> set[int]:
    """The lines on which a file has keys."""
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
    said: Mapping[str, GroupChange] = MappingProxyType({}),
    settings: Mapping[str, Any] = MappingProxyType({}),
) -> str:
    """A file in which a node's handlers are in a group, and in no other of its groups.

    Args:
        said: What another file says of the node's groups, which this one would replace as a whole.
        settings: What is set for the group besides: its `limit`, `thread`.
    """

    def change(node: CommentedMap) -> None:
        base = {} if "concurrency" in node else said
        groups = _below(node, "concurrency")
        for name, about in base.items():
            groups[name] = _flow(plain(about))
        for other in list(groups):
            members = groups[other]
            listed = members.get("handlers") if isinstance(members, CommentedMap) else members
            if isinstance(listed, list):
                for handler in handlers:
                    while other != group and handler in listed:
                        listed.remove(handler)
        present = groups.get(group)
        if isinstance(present, CommentedMap):
            if handlers:
                here = present.setdefault("handlers", [])
                here.extend(h for h in handlers if h not in here)
        elif isinstance(present, list):
            present.extend(h for h in handlers if h not in present)
        else:
            groups[group] = _flow_list(handlers)
        if settings:
            members = groups[group]
            if not isinstance(members, CommentedMap):
                members = groups[group] = _flow({"handlers": members} if members else {})
            members.update(settings)

    return _changed(text, path, change)


def with_params(text: str, path: KeyPath, values: Mapping[str, Any]) -> str:
    """A file in which a node's parameters have other values."""

    def change(node: CommentedMap) -> None:
        params = _below(node, "params")
        for name, value in values.items():
            params[name] = _flow_list(value) if isinstance(value, (list, tuple)) else value

    return _changed(text, path, change)


def with_console(text: str, section: Mapping[str, Any]) -> str:
    """A file with other windows in its `console:` section; what else the section says is kept."""
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


def _changed(text: str, path: KeyPath, change: Any) -> str:
    data = _load(text, "the graph file")
    node: Any = data
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


def _flow_list(values: Sequence[Any]) -> Any:
    return _flow(list(values))


def _flow(value: Any) -> Any:
    """Plain data to be written on one line."""
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
    yaml.brace_single_entry_mapping_in_flow_sequence = True
    yaml.width = _WIDTH
    indent = _indent(text)
    yaml.indent(mapping=indent, sequence=indent + 2, offset=indent)
    return yaml


def _indent(text: str) -> int:
    """The first indentation of the file."""
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
