"""YAML text as plain values that remember where they were written.

One reader serves graph files, parameter values and message texts: PyYAML's parser with YAML 1.2's core scalars, so
that `on`, `12:30` and `1_000` are strings and `1e3` is a number. What makes YAML unsafe or ambiguous is refused with
its place before anything is built: aliases, tags, duplicate keys, keys that are not strings, excessive size or depth.
"""

from __future__ import annotations

import re
from typing import Any, NamedTuple

import yaml

from graphflow.errors import GraphFileError, GraphflowError, Place, Problem

MAX_BYTES = 1_000_000
MAX_DEPTH = 40
MAX_VALUES = 50_000

Path = tuple[str | int, ...]
"""Keys and indices from the top of a file down to a value."""

_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

_INT = re.compile(r"[-+]?[0-9]+\Z|0o[0-7]+\Z|0x[0-9a-fA-F]+\Z")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?\Z")
_SPECIAL: dict[str, Any] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **{f"{sign}{word}": float(f"{sign}inf") for sign in ("", "+", "-") for word in (".inf", ".Inf", ".INF")},
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
}


class Source(NamedTuple):
    """A file's values, and where each was written."""

    data: Any
    places: dict[Path, Place]
    """The place of each value."""
    keys: dict[Path, Place]
    """The place of each mapping key; the path ends with the key."""

    def place(self, path: Path) -> Place:
        """The place of a value, or of the nearest thing above it that was written."""
        while path and path not in self.places:
            path = path[:-1]
        return self.places.get(path, Place(self.file))

    def key_place(self, path: Path) -> Place:
        """The place of the key that `path` ends with."""
        return self.keys.get(path, self.place(path))

    @property
    def file(self) -> str:
        return next(iter(self.places.values())).file


def scalar(text: str) -> Any:
    """An unquoted YAML scalar as Python value, by YAML 1.2's core schema.

    Raises:
        ValueError: A number too long to be one.
    """
    if text in _SPECIAL:
        return _SPECIAL[text]
    if _INT.match(text):
        return int(text, 0) if text[:2] in ("0o", "0x") else int(text)
    if _FLOAT.match(text):
        return float(text)
    return text


class _Frame(NamedTuple):
    container: Any
    path: Path


def read(text: str, file: str) -> Source:
    """Read one YAML document.

    Args:
        file: The name to give in messages.

    Raises:
        GraphFileError: It is not YAML, or uses what is refused here; the first such place.
    """
    if len(text.encode(errors="replace")) > MAX_BYTES:
        raise _error(Place(file), f"the file is larger than {MAX_BYTES:,} bytes")
    try:
        return _build(text, file)
    except yaml.MarkedYAMLError as error:
        mark: Any = error.problem_mark or error.context_mark
        place = Place(file, mark.line + 1, mark.column + 1) if mark else Place(file)
        raise _error(place, f"not valid YAML: {error.problem}{_indent_hint(text, error)}") from None
    except yaml.YAMLError as error:
        raise _error(Place(file), f"not valid YAML: {' '.join(str(error).split())}") from None


def _indent_hint(text: str, error: yaml.MarkedYAMLError) -> str:
    mark = error.problem_mark
    lines = text.splitlines()
    if mark and mark.line < len(lines) and "\t" in lines[mark.line]:
        return " (indent with spaces, not tabs)"
    if mark and mark.line and "mapping values are not allowed" in str(error.problem):
        return " (quote a text that has ': ' in it)"
    return ""


def _error(place: Place, message: str) -> GraphFileError:
    return GraphFileError([Problem(place, message)])


def _build(text: str, file: str) -> Source:
    places: dict[Path, Place] = {}
    keys: dict[Path, Place] = {}
    stack: list[_Frame] = []
    pending: list[str | None] = []
    root: list[Any] = []
    documents = count = 0

    def put(value: Any, place: Place) -> Path:
        if not stack:
            root.append(value)
            places[()] = place
            return ()
        container, above = stack[-1]
        if isinstance(container, list):
            path = (*above, len(container))
            container.append(value)
        else:
            key = pending[-1]
            assert key is not None
            path = (*above, key)
            container[key] = value
            pending[-1] = None
        places[path] = place
        return path

    for event in yaml.parse(text, Loader=_LOADER):
        mark: Any = event.start_mark
        place = Place(file, mark.line + 1, mark.column + 1)
        if isinstance(event, yaml.DocumentStartEvent):
            documents += 1
            if documents > 1:
                raise _error(place, "one document per file: remove the line '---'")
        elif isinstance(event, yaml.AliasEvent):
            raise _error(place, f"*{event.anchor}: aliases are not used here; write the value out")
        elif isinstance(event, (yaml.MappingEndEvent, yaml.SequenceEndEvent)):
            if isinstance(stack.pop().container, dict):
                pending.pop()
        elif isinstance(event, yaml.NodeEvent):
            count += 1
            if count > MAX_VALUES:
                raise _error(place, f"more than {MAX_VALUES:,} values")
            tag = getattr(event, "tag", None)
            if tag not in (None, "!", "tag:yaml.org,2002:str"):
                raise _error(place, f"{tag}: tags are not used here; write a plain value")
            waits_for_key = bool(stack) and isinstance(stack[-1].container, dict) and pending[-1] is None
            if waits_for_key:
                key = _key(event, place)
                container, above = stack[-1]
                if key in container:
                    first = keys[(*above, key)]
                    raise _error(place, f"the key {key!r} stands here twice; first in line {first.line}")
                keys[(*above, key)] = place
                pending[-1] = key
                continue
            if isinstance(event, yaml.ScalarEvent):
                put(_scalar_value(event, place), place)
                continue
            new: Any = {} if isinstance(event, yaml.MappingStartEvent) else []
            path = put(new, place)
            stack.append(_Frame(new, path))
            if isinstance(new, dict):
                pending.append(None)
            if len(stack) > MAX_DEPTH:
                raise _error(place, f"nested more than {MAX_DEPTH} deep")
    if not root:
        root.append(None)
        places[()] = Place(file, 1, 1)
    return Source(root[0], places, keys)


def _key(event: Any, place: Place) -> str:
    if not isinstance(event, yaml.ScalarEvent):
        raise _error(place, "a key must be a word, not a list or mapping")
    if not event.style and not isinstance(_scalar_value(event, place), str):
        raise _error(place, f"the key {event.value!r} must be quoted, or it is no text")
    return str(event.value)


def _scalar_value(event: Any, place: Place) -> Any:
    if event.style or event.tag == "tag:yaml.org,2002:str":
        return event.value
    try:
        return scalar(event.value)
    except ValueError:
        raise _error(place, f"{event.value[:20]}... has too many digits") from None


def parse_value(text: str) -> Any:
    """The value of a YAML text from the command line: `200`, `true`, `{x: 1.0}`.

    Raises:
        GraphflowError: It is not YAML; the text says where.
    """
    try:
        return read(text, "value").data
    except GraphFileError as error:
        problem = error.problems[0]
        raise GraphflowError(f"{text!r}, character {problem.place.column}: {problem.message}") from None
