"""ROS 2's parameter files: parameters by node.

    /turtle1/follower:            the node's full name, or /** for all nodes, /* for those of one level
      ros__parameters:
        gain: 2.0
        limits: {speed: 1.0}      the same as limits.speed

A key without its leading slash means the same, and namespaces may be nested mappings. If several sections match a
node, the last one wins.

Source: rcl_yaml_param_parser. Unlike there, a section that matches no node is an error.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from graphflow.errors import GraphFileError, Place, Problem
from graphflow.graph.plan import Setting
from graphflow.markup import source
from graphflow.markup.source import Source
from graphflow.names import did_you_mean, nearest

PARAMETERS = "ros__parameters"
_RUNS = {"class", "pkg", "command", "template"}
"""Keys of a node in a graph file."""


class Section(NamedTuple):
    """The parameters for the nodes that match a pattern."""

    pattern: str
    """A node's full name; `*` matches one part of it and `**` any number."""
    place: Place
    params: dict[str, Setting]

    @property
    def is_exact(self) -> bool:
        """Whether the section names a single node."""
        return "*" not in self.pattern

    def fits(self, node: str) -> bool:
        """Return whether the section matches a node's full name."""
        parts = [{"**": ".*", "*": "[^/]+"}.get(p, re.escape(p)) for p in self.pattern[1:].split("/")]
        # `**` also matches no part at all, so the slash behind it is optional.
        return re.fullmatch("/" + "/".join(parts).replace(".*/", "(?:.*/)?"), node) is not None


def flatten(
    src: Source, params: Mapping[str, object], path: source.Path, problems: list[Problem]
) -> dict[str, Setting]:
    """Flatten nested mappings of parameters to dotted names.

    Args:
        path: The path of `params` in `src`.
        problems: The list to which problems are added.
    """
    found: dict[str, Setting] = {}

    def walk(prefix: str, values: Mapping[str, object], at: source.Path) -> None:
        for key, value in values.items():
            name, place = prefix + key, src.place((*at, key))
            if isinstance(value, dict):
                walk(f"{name}.", value, (*at, key))
            elif value is None:
                text = f"parameter {name!r} has no value; {_instead_of(key)}"
                problems.append(Problem(src.key_place((*at, key)), text))
            elif name in found:
                first = found[name].place.line
                problems.append(Problem(place, f"parameter {name!r} is given twice, first on line {first}; remove one"))
            else:
                found[name] = Setting(value, place)

    walk("", params, path)
    return found


def _instead_of(key: str) -> str:
    """Return the correction of a key without a value."""
    if key.isdecimal():
        return "a number is written with a point, as 2.5"
    word, sign, given = re.findall(r"\A([^:=]*)(:?=?)(.*)\Z", key, re.DOTALL)[0]
    if sign == ":" and given:
        return f"as a whole it is read as a name: write {word}: {given.strip()}, without quotes"
    return f"write {word}: {given.strip()}" if sign and given else "an empty string is ''"


def read(path: Path, name: str, remark: source.Complain | None = None) -> list[Section]:
    """Read the sections of a file.

    Args:
        name: The file as messages show it.
        remark: As for `source.read`.

    Raises:
        GraphFileError: The file cannot be read, or is no parameter file; all mistakes, with their places.
    """
    src = source.read_file(path, name, is_params=True, remark=remark)
    problems: list[Problem] = []
    sections = list(_sections(src, problems))
    if not sections and not problems:
        problems.append(Problem(src.place(()), f"the file has no section; write NODE: {{{PARAMETERS}: {{rate: 2.0}}}}"))
    if problems:
        raise GraphFileError(problems)
    return sections


def _sections(src: Source, problems: list[Problem]) -> Iterator[Section]:
    def walk(values: Mapping[str, object], at: source.Path) -> Iterator[Section]:
        fault = _not_indented(src, values, at)
        if fault is not None:
            problems.append(fault)
            return
        for key, value in values.items():
            here = (*at, key)
            if key != PARAMETERS and nearest(key, [PARAMETERS], cutoff=0.85) is not None:
                problems.append(
                    Problem(src.key_place(here), f"{key!r}: did you mean {PARAMETERS!r}, with two _ in a row?")
                )
            elif not isinstance(value, dict):
                place = src.place(here) if isinstance(value, str) else src.key_place(here)
                if at and key == PARAMETERS:
                    problems.append(Problem(place, f"{PARAMETERS} is a mapping{_with_colon(value)}"))
                else:
                    above = f"{PARAMETERS}:" if at else f"/**: and, indented, {PARAMETERS}:"
                    problems.append(Problem(place, f"{key!r}: write above it {above} and indent it below that"))
            elif key == PARAMETERS and at:
                pattern = "/" + "/".join(str(part).strip("/") for part in at)
                params = flatten(src, value, here, problems)
                is_exact = "*" not in pattern
                yield Section(
                    pattern,
                    src.key_place(at),
                    {k: Setting(s.value, s.place, is_optional=not is_exact) for k, s in params.items()},
                )
            else:
                yield from walk(value, here)

    if not isinstance(src.data, dict):
        problems.append(Problem(src.place(()), f"a parameter file is a mapping: NODE: {{{PARAMETERS}: ...}}"))
        return
    nodes = src.data.get("nodes")
    if isinstance(nodes, dict) and any(isinstance(n, dict) and not _RUNS.isdisjoint(n) for n in nodes.values()):
        problems.append(Problem(src.key_place(("nodes",)), f"this is a graph file: graphflow up {src.file}"))
        return
    yield from walk(src.data, ())


def _not_indented(src: Source, values: Mapping[str, object], at: source.Path) -> Problem | None:
    """Return the problem of a mapping whose parameters are not indented below their node."""
    if PARAMETERS not in values:
        return None
    bare = next((key for key, value in values.items() if value is None), None)
    indented = PARAMETERS if bare != PARAMETERS else next((key for key in values if key != PARAMETERS), None)
    if bare is not None and indented is not None and (at or bare != PARAMETERS):
        place = src.key_place((*at, indented))
        return Problem(place, f"{indented!r} belongs below {bare!r}: indent it and what follows by two more spaces")
    if at:
        return None
    return Problem(src.key_place((PARAMETERS,)), f"{PARAMETERS} belongs below a node: write NODE: above, and indent it")


def _with_colon(value: object) -> str:
    """Return the correction of a text in place of a mapping of parameters."""
    found = re.match(r"([\w.]+)(?:\s*[=:]\s*|\s+)(\S+)", value) if isinstance(value, str) else None
    return ", for example {rate: 2.0}" if found is None else f"; write {found[1]}: {found[2]}"


def params_for(sections: Sequence[Section], node: str) -> dict[str, Setting]:
    """Return the parameters of all sections that match a node's full name."""
    found: dict[str, Setting] = {}
    for section in sections:
        if section.fits(node):
            found |= section.params
    return found


def hint_for(sections: Sequence[Section], node: str) -> str:
    """Return a hint for a file without parameters for a node: the section that may be misspelt."""
    places = {section.pattern: section.place for section in sections}
    near = nearest(node, places)
    return (
        did_you_mean(node, places) if near is None else f"; did you mean {node} in place of {near} at {places[near]}?"
    )


def strays(sections: Sequence[Section], nodes: Sequence[str]) -> list[Problem]:
    """Return the problems of sections that match none of the nodes."""
    return [
        Problem(s.place, f"there is no node {s.pattern}{did_you_mean(s.pattern, nodes)}")
        for s in sections
        if not any(s.fits(node) for node in nodes)
    ]


# ROS 2's parser and YAML 1.1 do not read these as text.
_NOT_TEXT = re.compile(r"(y|yes|n|no|on|off|true|false|null|nan|inf|infinity)\Z", re.IGNORECASE)
_PLAIN = re.compile(r"[A-Za-z_/][\w./-]*( [\w./-]+)*\Z")


def write(node: str, values: Mapping[str, object]) -> str:
    """Return a node's parameters as a file that this reader and ROS 2's both read with the same values and types."""
    tree: dict[str, object] = {}
    for name in sorted(values):
        *above, last = name.split(".")
        branch = tree
        for part in above:
            inner = branch.setdefault(part, {})
            if not isinstance(inner, dict):  # `a` and `a.b` are both parameters, so `a` cannot be a mapping
                break
            branch = inner
        else:
            branch[last] = values[name]
            continue
        tree[name] = values[name]
    lines = list(_written(tree, 2)) or ["    {}"]
    return "\n".join([f"{node}:", f"  {PARAMETERS}:", *lines]) + "\n"


def _written(tree: Mapping[str, object], depth: int) -> Iterator[str]:
    pad = "  " * depth
    for key, value in tree.items():
        name = key if _PLAIN.match(key) else _quoted(key)
        if isinstance(value, dict):
            yield f"{pad}{name}:"
            yield from _written(value, depth + 1)
        else:
            yield f"{pad}{name}: {_value(value)}"


def _value(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        if math.isnan(value):
            return ".nan"
        if math.isinf(value):
            return ".inf" if value > 0 else "-.inf"
        # PyYAML and YAML 1.1 take 1e-07 for text; a number with an exponent needs its point there.
        text = repr(value)
        return text if "." in text or "e" not in text else text.replace("e", ".0e", 1)
    if isinstance(value, (list, tuple, bytes)):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, str):
        return value if _PLAIN.match(value) and not _NOT_TEXT.match(value) else _quoted(value)
    return str(value)


def _quoted(text: str) -> str:
    if text.isprintable():
        return "'" + text.replace("'", "''") + "'"
    # Only double quotes know escapes.
    return '"' + text.encode("unicode_escape").decode().replace('"', '\\"') + '"'
