"""`include` and `override`: one graph file over another, merged before anything else is looked at.

    include: crossing_broken.yaml
    override:
      /b: {concurrency: {answers: [f]}}

The including file has its own `args`, `nodes`, `steps` and settings in addition to those of the file it includes. Under
`override` are nodes of the included file with the keys that should differ: `params`, `remap` and `env` entry by
entry, any other key as a whole. Every value keeps the place where it was written.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from graphflow.errors import GraphFileError, Place, Problem
from graphflow.graph import source
from graphflow.graph.project import shown
from graphflow.graph.source import Source
from graphflow.names import did_you_mean

_BY_ENTRY = ("params", "remap", "env")
"""Keys of a node that are overridden entry by entry."""
_SECTIONS = ("args", "nodes", "steps")
"""Keys of a file that hold entries of both files."""

Complain = Callable[[Place, str], None]


def merged(src: Source, path: Path, complain: Complain) -> tuple[Source, dict[str, Path]]:
    """A file merged with what it includes.

    Args:
        complain: Called with each mistake.

    Returns:
        The whole, without the keys `include` and `override`, and the folder of each file by its shown name.

    Raises:
        GraphFileError: An included file cannot be read.
    """
    return _merged(src, path, complain, (path.resolve(),))


def _merged(src: Source, path: Path, complain: Complain, seen: tuple[Path, ...]) -> tuple[Source, dict[str, Path]]:
    folders = {src.file: path.resolve().parent}
    name = src.data.get("include")
    if name is None:
        if "override" in src.data:
            complain(src.key_place(("override",)), "override: goes with include:, whose nodes it changes")
        return src, folders
    place = src.place(("include",))
    if not isinstance(name, str) or not isinstance(src.data.get("override") or {}, dict):
        return src, folders  # reported when the keys' types are checked
    below = path.parent / name
    if below.resolve() in seen:
        complain(place, f"{name} includes itself")
        return src, folders
    if not below.is_file():
        near = did_you_mean(below.name, [f.name for f in below.parent.glob("*.yaml")])
        raise GraphFileError([Problem(place, f"there is no file {shown(below)}{near}")])
    included = source.read_file(below, shown(below))
    if not isinstance(included.data, dict):
        raise GraphFileError([Problem(place, f"{name} is not a graph file: it holds no mapping")])
    base, its_folders = _merged(included, below, complain, (*seen, below.resolve()))
    return _Merge(base, src, complain).done(), its_folders | folders


class _Merge:
    """Two sources becoming one."""

    def __init__(self, base: Source, over: Source, complain: Complain) -> None:
        self._base, self._over, self._complain = base, over, complain
        self._data: dict[str, Any] = {k: v for k, v in base.data.items() if k != "name"}
        self._places = {(): over.place(()), **{p: q for p, q in base.places.items() if p and p[0] != "name"}}
        self._keys = {p: q for p, q in base.keys.items() if p[0] != "name"}

    def done(self) -> Source:
        for key, value in self._over.data.items():
            if key in _SECTIONS and isinstance(value, dict) and isinstance(self._data.get(key), dict):
                for entry in value:
                    if key == "nodes" and entry in self._data["nodes"]:
                        text = f"{entry} is already in the included file; change it under override:"
                        self._complain(self._over.key_place((key, entry)), text)
                    self._take((key, entry), (key, entry))
            elif key not in ("include", "override"):
                self._take((key,), (key,))
        for node, changes in (self._over.data.get("override") or {}).items():
            self._change(node, changes)
        return Source(self._data, self._places, self._keys)

    def _change(self, node: str, changes: Any) -> None:
        at = ("override", node)
        nodes = self._base.data.get("nodes")
        nodes = nodes if isinstance(nodes, dict) else {}
        if node not in nodes:
            near = did_you_mean(node, nodes)
            self._complain(self._over.key_place(at), f"the included file has no node {node!r}{near}")
        elif not isinstance(changes, dict):
            self._complain(self._over.place(at), f"{node}: expected a mapping of what differs, got {changes!r}")
        else:
            for key, value in changes.items():
                old = nodes[node].get(key) if isinstance(nodes[node], dict) else None
                if key in _BY_ENTRY and isinstance(value, dict) and isinstance(old, dict):
                    for entry in value:
                        self._take((*at, key, entry), ("nodes", node, key, entry))
                else:
                    self._take((*at, key), ("nodes", node, key))

    def _take(self, old: source.Path, new: source.Path) -> None:
        """Put a value of the including file in place of what the included one has there."""
        for table in (self._places, self._keys):
            for path in [p for p in table if p[: len(new)] == new]:
                del table[path]
        for table, its in ((self._places, self._over.places), (self._keys, self._over.keys)):
            for path, place in its.items():
                if path[: len(old)] == old:
                    table[(*new, *path[len(old) :])] = place
        value: Any = self._over.data
        for part in old:
            value = value[part]
        self._data = _with(self._data, new, value)


def _with(data: Any, path: source.Path, value: Any) -> Any:
    """A copy of `data` with another value at `path`."""
    if not path:
        return value
    head, *rest = path
    inside = data.get(head) if isinstance(data, dict) else None
    return {**(data if isinstance(data, dict) else {}), head: _with(inside, tuple(rest), value)}
