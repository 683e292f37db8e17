"""Validation of graph files by their model: unknown and missing keys, and wrong types, with corrections."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import TypeGuard, TypeVar, get_args, get_origin

from pydantic import BaseModel, ValidationError

from graphflow.errors import GraphFileError, Place, Problem
from graphflow.graph.checks import foreign_keys, rewritten
from graphflow.graph.model import BLOCKS, GroupBlock, NodeSpec, keys_of
from graphflow.markup import source
from graphflow.markup.source import Source
from graphflow.markup.validated import Fault
from graphflow.names import did_you_mean, nearest
from graphflow.times import seconds_in
from graphflow.typographic import is_quoted

M = TypeVar("M", bound=BaseModel)


class Problems(list[Problem]):
    """The problems found so far; a place whose value is unknown is reported once."""

    def __init__(self) -> None:
        super().__init__()
        self._unknown: set[Place] = set()
        self._of_nodes: dict[str, list[Problem]] = {}
        self.launch_files: set[str] = set()
        """Launch files, in which ROS's laxer rules apply."""
        self.remarks: list[Problem] = []
        """Oddities that are no errors."""
        self.left_out: list[Problem] = []
        """Programs of launch files that are not installed."""

    def add(self, place: Place, message: str) -> None:
        """Add a problem."""
        problem = Problem(place, f"{message}{_of_quotes(message)}")
        if place not in self._unknown and problem not in self:  # each round of a loop has the same
            self.append(problem)

    def add_unless_ros(self, place: Place, message: str) -> bool:
        """Add a remark in a launch file, as ROS accepts it, else a problem; returns whether it was a remark."""
        passes = place.file in self.launch_files
        if not passes:
            self.add(place, message)
        else:
            self.remark(place, message)
        return passes

    def remark(self, place: Place, message: str) -> None:
        """Add a remark."""
        if Problem(place, message) not in self.remarks:
            self.remarks.append(Problem(place, message))

    def leave_out(self, place: Place, message: str) -> None:
        """Add a program that is not installed: a remark if anything else is started, else a problem."""
        if Problem(place, message) not in self.left_out:
            self.left_out.append(Problem(place, message))

    def add_unknown(self, place: Place, message: str) -> None:
        """Add a problem that leaves a value unknown, so that no further problems of it are reported."""
        self.add(place, message)
        self._unknown.add(place)

    @contextmanager
    def of_node(self, name: str) -> Iterator[None]:
        """Assign the problems added within to a node."""
        known = len(self)
        yield
        self._of_nodes[name] = self[known:]

    def forget(self, names: Iterable[str]) -> None:
        """Drop the problems of nodes that are left out."""
        forgotten = [fault for name in names for fault in self._of_nodes.get(name, ())]
        self[:] = [problem for problem in self if problem not in forgotten]

    def raise_any(self) -> None:
        """Raise GraphFileError if there are any problems."""
        if self:
            raise GraphFileError(self)


def validated(model: type[M], src: Source, problems: Problems) -> M | None:
    """Validate a file or block; None, with problems added, if its keys or types are wrong."""
    faults: list[tuple[source.Path, Fault]]
    try:
        return model.model_validate(src.data)
    except ValidationError as error:
        faults = [(_written_path(src, fault), fault) for fault in error.errors()]
    faults = _without_strays(faults, src, problems)
    wanted: dict[source.Path, list[str]] = {}
    paths = [path for path, _ in faults]
    for path, fault in faults:
        # Each alternative of a union reports its faults; the one that matched furthest was meant.
        if not any(other[: len(path)] == path and other != path for other in paths):
            wanted.setdefault(path, []).append(_wanted(fault))
    for path, fault in faults:
        if fault["type"] == "missing":
            if not _misspelt(model, str(path[-1]), path[:-1], faults):
                others = "; a program has pkg: and exec:, or command:" if path[-1] == "class" else ""
                problems.add(src.key_place(path[:-1]), f"the key {str(path[-1])!r} is missing{others}")
        elif fault["type"] == "extra_forbidden":
            problems.add(src.key_place(path), unknown_key(str(path[-1]), _known_keys(model, path), fault["input"]))
        elif fault["type"] == "value_error":
            problems.add(src.place(path), str(fault["ctx"]["error"]))
        elif path in wanted:
            problems.add(src.place(path), _wrong_type(model, path, wanted.pop(path), fault["input"]))
    return None


def _without_strays(
    faults: list[tuple[source.Path, Fault]], src: Source, problems: Problems
) -> list[tuple[source.Path, Fault]]:
    """Report misplaced keys of nodes; returns the other faults."""
    strays = {path[:2]: str(path[1]).lstrip("/") for path, fault in faults if _is_stray(path, fault)}
    for path, key in strays.items():
        problems.add(src.key_place(path), _belongs_to_a_node(f"{key}:", key))
    return [(path, fault) for path, fault in faults if path[:2] not in strays]


def _written_path(src: Source, fault: Fault) -> source.Path:
    """Return the path of a fault in the file: its location without the names of union alternatives."""
    path: source.Path = ()
    for part in fault["loc"]:
        if (*path, part) in src.places or (*path, part) in src.keys:
            path = (*path, part)
    return (*path, fault["loc"][-1]) if fault["type"] == "missing" else path


def _is_stray(path: source.Path, fault: Fault) -> bool:
    """Return whether an entry of `nodes` is a misplaced key of a node: it has the name of one, and no class."""
    if len(path) < 2 or path[0] != "nodes" or str(path[1]).lstrip("/") not in keys_of(NodeSpec):
        return False
    return len(path) == 2 or (len(path) == 3 and path[2] == "class" and fault["type"] == "missing")


def _belongs_to_a_node(subject: str, key: str) -> str:
    several = ", or for several nodes into a group: with its nodes:" if key in keys_of(GroupBlock) else ""
    beside = "" if key == "class" else ", beside class:"
    return f"{subject} belongs to a node; indent it below the node's name{beside}{several}"


def _misspelt(
    model: type[BaseModel], key: str, above: source.Path, faults: Sequence[tuple[source.Path, Fault]]
) -> bool:
    """Return whether a missing key is present with a typo, which is reported as an unknown key."""
    unknown = [str(p[-1]) for p, f in faults if f["type"] == "extra_forbidden" and p[:-1] == above]
    of_ros = key == "class" and not {"package", "executable"}.isdisjoint(unknown)
    of_ros = of_ros or (key == "class" and any(_is_nested(f["input"]) for p, f in faults if p[:-1] == above))
    of_ros = of_ros or any(foreign_keys.correction(word, [key]) for word in unknown)
    return of_ros or any(nearest(word, _known_keys(model, (*above, word))) == key for word in unknown)


def _is_nested(value: object) -> bool:
    """Whether a value under an unknown key of a node is a node itself."""
    return isinstance(value, dict) and not value.keys().isdisjoint(("class", "exec"))


def _known_keys(model: type[BaseModel], path: source.Path) -> list[str]:
    """Return the keys of the model that contains the last key of a path."""
    found: object = model
    for part in path[:-1]:
        if _is_model(found):
            fields = {field.alias or name: field.annotation for name, field in found.model_fields.items()}
            found = fields.get(str(part))
        else:  # the type of the entries of a mapping or list
            found = get_args(found)[-1] if get_args(found) else None
        if get_origin(found) not in (dict, list):
            found = next(filter(_is_model, get_args(found)), found)
    return keys_of(found) if _is_model(found) else []


def _is_model(kind: object) -> TypeGuard[type[BaseModel]]:
    return isinstance(kind, type) and issubclass(kind, BaseModel)


def unknown_key(key: str, known: Collection[str], value: object = None) -> str:
    """Return the problem of an unknown key, with the key that was probably meant.

    Args:
        value: The value under the key.
    """
    correction = (
        _in_file(key, known, value)
        or foreign_keys.correction(key, known)
        or _in_block(key, known, value)
        or _in_step(key, known)
    )
    if correction:
        return f"unknown key {key!r}; {correction}"
    of_nodes = keys_of(NodeSpec)
    if "nodes" in known and key in of_nodes:
        return _belongs_to_a_node(f"{key}:", key)
    if "nodes" in known and nearest(key, known) is None and (near := nearest(key, of_nodes)):
        return f"unknown key {key!r}; did you mean {near!r}? {_belongs_to_a_node('It', near)}"
    head = key.partition(":")[0]
    if head in known and head != key:
        return f"unknown key {key!r}; write a space after '{head}:'"
    if "params" in known and isinstance(value, (bool, int, float)) and nearest(key, known, cutoff=0.75) is None:
        return (
            f"unknown key {key!r}; a parameter is written under params:, as in params: {{{key}: {str(value).lower()}}}"
        )
    listed = did_you_mean(key, known) or "; there is " + ", ".join(sorted(known))
    return f"unknown key {key!r}{listed}"


def _in_file(key: str, known: Collection[str], value: object) -> str:
    """Return the correction of an unknown key of a file or group; empty if none is known."""
    if "nodes" not in known:
        return ""
    if isinstance(value, dict) and "ros__parameters" in value:
        return (
            "this is a file of parameters: a node of a graph file has params_file: FILE, and run takes "
            "--params-file FILE"
        )
    return "nodes are written under nodes:, indented" if _is_node(key, value) else ""


def _in_block(key: str, known: Collection[str], value: object) -> str:
    """Return the correction of a key that was meant as a loop or a group; empty if none is known."""
    if "for" in known and (loop := _LOOP.match(key)):
        return f"write for: {{var: {loop[1]}, in: {loop[2]}, nodes: ...}}"
    if {"class", "exec"} <= {*known} and _is_nested(value):
        return f"nodes are not nested: a namespace is part of the name, as in /NAMESPACE/{key}:"
    if "namespace" in known and isinstance(value, dict) and not value.keys().isdisjoint(BLOCKS):
        return f"a group is named by its namespace: group: {{namespace: {key}, nodes: ...}}"
    return ""


def _in_step(key: str, known: Collection[str]) -> str:
    """Return the correction of an unknown key of a step; empty if none is known."""
    if "call" not in known:
        return ""
    if key.startswith("pub"):
        return "no step publishes: let a node do it, or graphflow topic pub"
    return "the values of a call or a goal are written under request:" if key in _REQUESTS else ""


def colon_fault(key: str) -> str:
    """Return the fault of a missing or misplaced colon after a node's name; empty if there is none."""
    if ":" in key:
        return f"the name {key!r} has a colon in it; write a space after the colon that ends a key"
    name, brace, _ = key.partition("{")
    return f"a colon is missing after {name.rstrip()!r}" if brace else ""


def _is_node(key: str, value: object) -> bool:
    return key.startswith("/") or (isinstance(value, dict) and not {"class", "exec", "command"}.isdisjoint(value))


_REQUESTS = ("args", "arguments", "data", "fields", "values")
_LOOP = re.compile(r"for +(\w+) +in +(.+)")


def _wanted(fault: Fault) -> str:
    limits = fault.get("ctx", {})
    words = {
        "dict_type": "a mapping",
        "model_type": "a mapping",
        "string_type": "text",
        "list_type": "a list",
        "int_type": "a whole number",
        "float_type": "a number",
        "bool_type": "true or false",
        "greater_than": f"more than {limits.get('gt', 0):g}",
        "greater_than_equal": f"{limits.get('ge', 0):g} or more",
        "finite_number": "a finite number",
    }
    return words.get(fault["type"], str(fault["msg"]))


def _wrong_type(model: type[BaseModel], path: source.Path, wanted: list[str], value: object) -> str:
    if "a number" in wanted:
        wanted = [w for w in wanted if w != "a whole number"]
    parts = path[2:] if path[0] in ("nodes", "steps") and len(path) > 2 else path[-1:] if path[0] == "nodes" else path
    where = ".".join(str(p) for p in parts)
    text = " or ".join(dict.fromkeys(wanted))
    head = str(value).partition(":")[0]
    if isinstance(value, str) and head in _known_keys(model, (*path, head)):
        return f"{where}: write a space after '{head}:'"
    if "a number" in wanted and path[-1] in _IN_SECONDS and isinstance(value, str) and (number := seconds_in(value)):
        return f"{where}: expected {text} of seconds; write {path[-1]}: {number}"
    if line := rewritten.line_for(str(path[-1]), value):
        return f"{where}: expected {text}; write {line}"
    if len(path) == 2 and path[0] == "args" and not isinstance(value, (dict, list)):
        return f"{where}: expected {text}; write {path[1]}: {rewritten.flow({'default': value})}"
    if len(path) == 4 and path[2] == "concurrency" and isinstance(value, int) and not isinstance(value, bool):
        return f"{where}: expected {text}; write {path[3]}: {rewritten.flow({'limit': value})}"
    got = _SHOWN[value] if value is None or isinstance(value, bool) else repr(value)
    shown = example(*path) or (example(*path[:-1]) if value is None else "")  # a key without a value, as in {a, b}
    return f"{where}: expected {text}, got {got if len(got) <= 60 else got[:60] + '...'}{shown}"


_IN_SECONDS = ("delay", "max_delay", "within", "timeout")
_SHOWN = {None: "nothing", True: "true", False: "false"}
_EXAMPLES: dict[source.Path, str] = {
    ("args",): "args: {rate: {default: 1.0}}",
    ("args", ""): "{default: 1.0}",
    ("nodes",): "nodes: {/talker: {class: nodes.talker:Talker}}",
    ("nodes", ""): "{class: nodes.talker:Talker}",
    ("nodes", "", "params"): "params: {rate: 2.0}",
    ("nodes", "", "params_file"): "params_file: params.yaml",
    ("nodes", "", "remap"): "remap: {goal: /turtle1/pose}",
    ("nodes", "", "env"): "env: {LANG: C}",
    ("nodes", "", "after"): "after: /talker",
    ("nodes", "", "concurrency"): "concurrency: {motion: [control]}",
    ("nodes", "", "concurrency", ""): "motion: [control], or motion: {handlers: [control], limit: 2}",
    ("nodes", "", "command"): "command: [rviz2, -d, robot.rviz]",
    ("nodes", "", "args"): "args: [--fast, 3]",
    ("nodes", "", "restart"): "restart: on_failure, or restart: {policy: always, delay: 1.0}",
    ("group",): "group: {namespace: robot1, nodes: {talker: {class: nodes.talker:Talker}}}",
    ("for",): "for: {var: i, in: 1..3, nodes: {/talker$(var i): {class: nodes.talker:Talker}}}",
    ("include",): "include: base.yaml, or include: {file: base.yaml, args: {rate: 2.0}}",
    ("steps",): "steps: {spawn: {call: /spawn}}",
    ("steps", ""): "{call: /spawn}",
    ("steps", "", "request"): "request: {x: 1.0}",
}


def example(*path: str | int) -> str:
    """Return an example of the value at a path, as the end of a message; empty if there is none."""
    shape = tuple("" if i in (1, 3) else part for i, part in enumerate(path))
    return f", for example {_EXAMPLES[shape]}" if shape in _EXAMPLES else ""


_TEXT = re.compile(r"'([^']*)'")


def _of_quotes(message: str) -> str:
    """Return a hint for a message about a text with typographic quotes or no-break spaces."""
    if "\\xa0" in message:
        return " (\\xa0 is a no-break space, which YAML does not count as a space)"
    for found in _TEXT.findall(message):
        if is_quoted(text := found.strip("/: ")):
            return f" ({text[0]} and {text[-1]} are not quotes in YAML, which has ' and \")"
    return ""
