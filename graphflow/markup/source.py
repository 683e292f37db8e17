"""YAML text as plain values that remember where they were written.

One reader serves graph files, parameter values and message texts: PyYAML's parser with YAML 1.2's core scalars, so
that `on`, `12:30` and `1_000` are strings and `1e3` is a number. What makes YAML unsafe or ambiguous is refused with
its place before anything is built: aliases, tags, duplicate keys, keys that are not strings, excessive size or depth.
"""

from __future__ import annotations

import pathlib
import re
from collections.abc import Callable
from typing import Any, NamedTuple

import yaml

from graphflow.errors import GraphFileError, GraphflowError, Place, Problem
from graphflow.markup import yaml_slips
from graphflow.reading import found_bytes
from graphflow.typographic import is_quoted, plain

MAX_BYTES = 1_000_000
MAX_DEPTH = 40
MAX_VALUES = 50_000

Path = tuple[str | int, ...]
"""Keys and indices from the top of a file down to a value."""

_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

_INT = re.compile(r"[-+]?[0-9]+\Z|0o[0-7]+\Z|0x[0-9a-fA-F]+\Z")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?\Z")
_UNPRINTABLE = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_KEYS_ONLY = re.compile(r"\{\s*([-\d.]+)\s*(?:,[^:{}]*)?\}")
"""A mapping of values without names: `{255, 0}`."""
_APOSTROPHE = re.compile(r"'[^']*\w'\w")
"""A quoted text that ends where a word goes on."""
_COMMA = re.compile(r"(?<![\w.])([-+]?\d+),\Z")
"""The whole part of a number with a comma for its point."""
_SPECIAL: dict[str, Any] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **{f"{sign}{word}": float(f"{sign}inf") for sign in ("", "+", "-") for word in (".inf", ".Inf", ".INF")},
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
}


class Source(NamedTuple):
    """A file's values and where each was written."""

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
        return self.places[()].file


def scalar(text: str) -> Any:
    """An unquoted YAML scalar as a Python value, by YAML 1.2's core schema.

    Raises:
        ValueError: A number with too many digits.
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


def read_file(
    path: pathlib.Path, name: str, *, is_params: bool = False, complain: Callable[[Place, str], None] | None = None
) -> Source:
    """Read a YAML file.

    Args:
        name: The file as messages show it.
        is_params, complain: As for `read`.

    Raises:
        GraphFileError: As for `read`; also when there is no such file, it is not a regular one, or it is not text.
    """
    try:
        data = found_bytes(path, MAX_BYTES)
    except OSError as error:
        raise _error(Place(name), f"cannot be read: {error.strerror}") from None
    try:
        return read(data.decode("utf-8-sig"), name, is_params=is_params, complain=complain)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise _error(Place(name, line), "is not UTF-8 text; save the file as UTF-8") from None


def read(
    text: str, file: str, *, is_params: bool = False, complain: Callable[[Place, str], None] | None = None
) -> Source:
    """Read one YAML document.

    Args:
        file: The name to give in messages.
        is_params: Whether it is read as ROS reads files of parameters: every key is a text, and mappings under the
            same key are one.
        complain: Called with each key that is not a text, which is left out then; None for an error.

    Raises:
        GraphFileError: `text` is not YAML, or uses what is refused here; the first such place.
    """
    if len(text.encode(errors="replace")) > MAX_BYTES:
        raise _error(Place(file), f"the file is larger than {MAX_BYTES:,} bytes")
    unprintable = _UNPRINTABLE.search(text)
    if unprintable:
        before = text[: unprintable.start()]
        place = Place(file, before.count("\n") + 1, len(before) - before.rfind("\n"))
        raise _error(place, f"the character U+{ord(unprintable[0]):04X} is not allowed in a YAML file; delete it")
    try:
        return _build(text, file, is_params=is_params, complain=complain or _refuse)
    except yaml.MarkedYAMLError as error:
        mark: Any = error.problem_mark or error.context_mark
        lines = text.splitlines()
        if mark and mark.line >= len(lines):  # the end of the text: point after its last character
            place = Place(file, len(lines), len(lines[-1]) + 1) if lines else Place(file, 1, 1)
        else:
            place = Place(file, mark.line + 1, mark.column + 1) if mark else Place(file)
        if "nesting depth" in str(error.problem):  # libyaml, which reads ahead, has a limit of its own
            raise _error(place, f"nested more than {MAX_DEPTH} deep") from None
        raise _error(place, f"not valid YAML: {error.problem}{_hint(text, error)}") from None
    except yaml.YAMLError as error:
        raise _error(Place(file), f"not valid YAML: {' '.join(str(error).split())}") from None


def _hint(text: str, error: yaml.MarkedYAMLError) -> str:
    """What to do about the parser's complaint, for common mistakes."""
    mark: Any = error.problem_mark
    start: Any = error.context_mark
    problem, context = str(error.problem), str(error.context)
    lines = text.splitlines()
    line = lines[mark.line] if mark and mark.line < len(lines) else ""
    if "\t" in line[: mark.column + 1 if mark else 0]:
        return " (indent with spaces, not tabs)"
    if slip := yaml_slips.of_line(line):
        return f" ({slip})"
    if "${" in line:
        return " (a substitution is written with parentheses, as in $(var x))"
    if "mapping values are not allowed" in problem:
        return " (quote a text that has ': ' in it; indent more below a key)"
    if "cannot start any token" in problem and line:
        return f" (quote a text that begins with {line[mark.column]})"
    if _APOSTROPHE.search(line[: mark.column + 1 if mark else 0]):
        return " (an apostrophe in quotes is written twice: 'it''s')"
    where = f"line {start.line + 1}, column {start.column + 1}" if start else ""
    bracket = lines[start.line][start.column : start.column + 1] if start and start.line < len(lines) else ""
    if bracket in ("{", "["):
        return f" (the {bracket} in {where} is not closed, or a text after it needs quotes)"
    if "quoted scalar" in context and "unexpected end" in problem:
        return f" (the quote in {where} is not closed)"
    if "expected key" in problem:
        return " (indent the keys of one mapping with the same number of spaces)"
    return ""


def _error(place: Place, message: str) -> GraphFileError:
    return GraphFileError([Problem(place, message)])


def _refuse(place: Place, message: str) -> None:
    raise _error(place, message)


def _build(text: str, file: str, *, is_params: bool, complain: Callable[[Place, str], None]) -> Source:
    places: dict[Path, Place] = {}
    keys: dict[Path, Place] = {}
    stack: list[_Frame] = []
    pending: list[str | None] = []
    root: list[Any] = []
    told: set[tuple[int, str]] = set()
    refused: list[tuple[dict[str, Any], str]] = []
    documents = count = 0

    def twice(key: str, first: Place, place: Place) -> GraphFileError:
        return _error(place, f"the key {key!r} is here twice, first on line {first.line}; remove one")

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
            if key in container and not any(one is container and name == key for one, name in refused):
                raise twice(key, keys[path], place)
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
                raise _error(place, f"the file has more than {MAX_VALUES:,} values")
            tag = getattr(event, "tag", None)
            if tag not in (None, "!", "tag:yaml.org,2002:str"):
                written = tag.replace("tag:yaml.org,2002:", "!!")
                raise _error(place, f"{written}: tags are not used here; write a plain value")
            waits_for_key = bool(stack) and isinstance(stack[-1].container, dict) and pending[-1] is None
            if waits_for_key:
                key = _key(event, place)
                container, above = stack[-1]
                if not is_params and (fault := _key_fault(event, place, text)):
                    if (place.line, fault) not in told:  # a list without brackets has several such keys
                        complain(place, fault)
                    told.add((place.line, fault))
                    refused.append((container, key))
                elif key in container and not (is_params and isinstance(container[key], dict)):
                    raise twice(key, keys[(*above, key)], place)
                keys.setdefault((*above, key), place)
                pending[-1] = key
                continue
            if isinstance(event, yaml.ScalarEvent):
                put(_scalar_value(event, place), place)
                continue
            new: Any = {} if isinstance(event, yaml.MappingStartEvent) else []
            before = stack[-1].container.get(pending[-1]) if stack and isinstance(stack[-1].container, dict) else None
            if isinstance(before, dict) and isinstance(new, dict):  # it goes on with what stands there already
                new, path, pending[-1] = before, (*stack[-1].path, str(pending[-1])), None
            else:
                path = put(new, place)
            stack.append(_Frame(new, path))
            if isinstance(new, dict):
                pending.append(None)
            if len(stack) > MAX_DEPTH:
                raise _error(place, f"nested more than {MAX_DEPTH} deep")
    for mapping, key in refused:
        mapping.pop(key, None)
    if not root:
        root.append(None)
        places[()] = Place(file, 1, 1)
    return Source(root[0], places, keys)


def _key(event: Any, place: Place) -> str:
    if not isinstance(event, yaml.ScalarEvent):
        raise _error(place, "a key must be a word, not a list or mapping")
    return str(event.value)


def _key_fault(event: Any, place: Place, text: str) -> str:
    """Why a key is none: it is no text. Empty for others."""
    if not event.style and is_quoted(event.value):
        return f"{event.value[0]} and {event.value[-1]} are no quotes in YAML; write {plain(event.value)}"
    if not event.style and (slip := yaml_slips.of_key(event.value, text.split("\n")[event.start_mark.line])):
        return slip
    if event.style or isinstance(_scalar_value(event, place), str):
        return ""
    if found := _KEYS_ONLY.search(text.split("\n")[event.start_mark.line]):
        return f"values have names: {{name: {found[1]}, ...}}"
    line, column = text.split("\n")[event.start_mark.line], event.start_mark.column
    before = _COMMA.search(line[:column])
    if before and event.value.isdecimal():
        return f"a number is written with a point: {before[1]}.{event.value}, not {before[1]},{event.value}"
    if slip := yaml_slips.of_number(line, column):
        return slip
    return f"the key {event.value} is not text; write it in quotes: '{event.value}'"


def _scalar_value(event: Any, place: Place) -> Any:
    if event.style or event.tag is not None:  # only the tags ! and !!str get this far, and both mean text
        return event.value
    try:
        return scalar(event.value)
    except ValueError:
        raise _error(place, f"{event.value[:20]}... has too many digits for a number; put text in quotes") from None


def parse_value(text: str) -> Any:
    """The value of a YAML text from the command line: `200`, `true`, `{x: 1.0}`.

    Raises:
        GraphflowError: `text` is not YAML; the message says where.
    """
    try:
        return read(text, "value").data
    except GraphFileError as error:
        problem = error.problems[0]
        raise GraphflowError(f"{text!r}, character {problem.place.column}: {problem.message}") from None
