"""What the model finds wrong in a graph file, in words: unknown and missing keys, wrong types, what was meant."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pydantic import BaseModel, ValidationError

from graphflow.errors import GraphFileError, Place, Problem
from graphflow.graph import source
from graphflow.graph.model import Arg, GraphFile, GroupSpec, NodeSpec, StepSpec, keys_of
from graphflow.graph.source import Source
from graphflow.names import did_you_mean, nearest

_MODELS: dict[str, type[BaseModel]] = {"args": Arg, "nodes": NodeSpec, "steps": StepSpec}


class Problems(list[Problem]):
    """The mistakes found so far; a place that is known to be wrong is reported once."""

    def __init__(self) -> None:
        super().__init__()
        self._unknown: set[Place] = set()

    def add(self, place: Place, message: str) -> None:
        """Add a problem."""
        if place not in self._unknown:
            self.append(Problem(place, message))

    def add_unknown(self, place: Place, message: str) -> None:
        """Add a problem that leaves the value unknown: further reports about it would only confuse."""
        self.add(place, message)
        self._unknown.add(place)

    def raise_any(self) -> None:
        """Raise GraphFileError if there are any."""
        if self:
            raise GraphFileError(self)


def validated(src: Source, problems: Problems) -> GraphFile | None:
    """The model of a file; None, with problems added, where its keys or types are wrong."""
    try:
        return GraphFile.model_validate(src.data)
    except ValidationError as error:
        faults = [(_written_path(src, fault), fault) for fault in error.errors()]
    wanted: dict[source.Path, list[str]] = {}
    paths = [path for path, _ in faults]
    for path, fault in faults:
        # Alternatives of a union report once each; the one that got furthest was meant.
        if not any(other[: len(path)] == path and other != path for other in paths):
            wanted.setdefault(path, []).append(_wanted(fault))
    for path, fault in faults:
        if fault["type"] == "missing":
            if not _misspelt(str(path[-1]), path[:-1], faults):
                problems.add(src.key_place(path[:-1]), f"the key {str(path[-1])!r} is missing")
        elif fault["type"] == "extra_forbidden":
            problems.add(src.key_place(path), _unknown_key(path))
        elif fault["type"] == "value_error":
            problems.add(src.place(path), str(fault["ctx"]["error"]))
        elif path in wanted:
            problems.add(src.place(path), _wrong_type(path, wanted.pop(path), fault["input"]))
    return None


def _written_path(src: Source, fault: Any) -> source.Path:
    """Where in the file a fault is, without the parts that name an alternative of a union."""
    path: source.Path = ()
    for part in fault["loc"]:
        if (*path, part) in src.places or (*path, part) in src.keys:
            path = (*path, part)
    return (*path, fault["loc"][-1]) if fault["type"] == "missing" else path


def _misspelt(key: str, above: source.Path, faults: Sequence[tuple[source.Path, Any]]) -> bool:
    """Whether a missing key is in fact there, with a typo that is reported anyway."""
    unknown = [str(p[-1]) for p, f in faults if f["type"] == "extra_forbidden" and p[:-1] == above]
    return any(nearest(word, _known_keys((*above, word))) == key for word in unknown)


def _known_keys(path: source.Path) -> list[str]:
    if len(path) == 5 and path[2] == "concurrency":
        return keys_of(GroupSpec)
    return keys_of(_MODELS[str(path[0])]) if len(path) == 3 and path[0] in _MODELS else keys_of(GraphFile)


def _unknown_key(path: source.Path) -> str:
    key, known = str(path[-1]), _known_keys(path)
    head = key.partition(":")[0]
    if head in known and head != key:
        return f"unknown key {key!r}; write a space after '{head}:'"
    return f"unknown key {key!r}{did_you_mean(key, known)}"


def _wanted(fault: Any) -> str:
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


def _wrong_type(path: source.Path, wanted: list[str], value: Any) -> str:
    if "a number" in wanted:
        wanted = [w for w in wanted if w != "a whole number"]
    where = ".".join(str(p) for p in path)
    text = " or ".join(dict.fromkeys(wanted))
    got = _SHOWN[value] if value is None or isinstance(value, bool) else repr(value)
    if len(path) == 2 and ":" in str(path[1]):
        return f"the name {path[1]!r} has a colon in it; write a space after the colon that ends a key"
    return f"{where}: expected {text}, got {got if len(got) <= 60 else got[:60] + '...'}{example(*path)}"


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
    ("steps",): "steps: {spawn: {call: /spawn}}",
    ("steps", ""): "{call: /spawn}",
    ("steps", "", "request"): "request: {x: 1.0}",
}


def example(*path: str | int) -> str:
    """An example of what may stand at a path, to end a report with; empty if there is none."""
    shape = tuple("" if i in (1, 3) else part for i, part in enumerate(path))
    return f", for example {_EXAMPLES[shape]}" if shape in _EXAMPLES else ""
