"""YAML text as plain values, each with its place.

One reader serves graph files, parameter values and message texts: PyYAML's parser with YAML 1.2's core scalars, so
that `on`, `12:30` and `1_000` are strings and `1e3` is a number. Unsafe or ambiguous YAML is refused with its place
before anything is built: aliases, tags, duplicate keys, keys that are not strings, excessive size or depth.
"""

from __future__ import annotations

import pathlib
import re
from collections.abc import Callable
from dataclasses import dataclass
from itertools import islice
from typing import NamedTuple, NoReturn, TypeAlias

import yaml

from graphflow.errors import GraphFileError, GraphflowError, Place, Problem
from graphflow.markup import yaml_slips
from graphflow.names import nearest
from graphflow.reading import found_bytes
from graphflow.typographic import is_quoted, plain

MAX_BYTES = 1_000_000
MAX_DEPTH = 40
MAX_VALUES = 50_000
SEARCHED = 1_000
"""Files of a folder that are searched for a name similar to that of a missing one, at most."""

Scalar: TypeAlias = bool | int | float | str | None
Data: TypeAlias = "Scalar | list[Data] | dict[str, Data]"
"""A YAML or JSON value."""
Path = tuple[str | int, ...]
"""Keys and indices from the top of a file down to a value."""
Complain = Callable[[Place, str], None]
"""Reports a problem at a place."""

try:
    _LOADER: type[yaml.CSafeLoader | yaml.SafeLoader] = yaml.CSafeLoader
except AttributeError:  # PyYAML was built without libyaml
    _LOADER = yaml.SafeLoader

_INT = re.compile(r"[-+]?[0-9]+\Z|0o[0-7]+\Z|0x[0-9a-fA-F]+\Z")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?\Z")
_UNPRINTABLE = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_LINE_BREAK = re.compile("\r\n|[\n\r\x85\u2028\u2029]")
"""The line breaks that the parser counts."""
_KEYS_ONLY = re.compile(r"\{\s*([-\d.]+)\s*(?:,[^:{}]*)?\}")
"""A mapping of values without names: `{255, 0}`."""
_APOSTROPHE = re.compile(r"'[^']*\w'\w")
"""A quoted text whose closing quote is followed by a letter: an apostrophe."""
_WHERE_A_KEY = re.compile("mapping values are not|expected key|expected ':'")
"""The parser's words for a key where none can be, or the reverse."""
_COMMA = re.compile(r"(?<![\w.])([-+]?\d+),\Z")
"""The integer part of a number with a decimal comma."""
_SPECIAL: dict[str, Scalar] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **{f"{sign}{word}": float(f"{sign}inf") for sign in ("", "+", "-") for word in (".inf", ".Inf", ".INF")},
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
}


class Source(NamedTuple):
    """The values of a file, with their places."""

    data: Data
    places: dict[Path, Place]
    """The place of each value."""
    keys: dict[Path, Place]
    """The place of each mapping key; the path ends with the key."""

    def place(self, path: Path) -> Place:
        """Return the place of a value, or of the nearest ancestor that has one."""
        while path and path not in self.places:
            path = path[:-1]
        return self.places.get(path, Place(self.file))

    def key_place(self, path: Path) -> Place:
        """Return the place of the key at the end of `path`."""
        return self.keys.get(path, self.place(path))

    @property
    def file(self) -> str:
        """The file's name, as messages show it."""
        return self.places[()].file


def scalar(text: str) -> Scalar:
    """Convert an unquoted YAML scalar to a Python value, by YAML 1.2's core schema.

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


def read_file(
    path: pathlib.Path,
    name: str,
    *,
    is_params: bool = False,
    complain: Complain | None = None,
    remark: Complain | None = None,
) -> Source:
    """Read a YAML file.

    Args:
        name: The file as messages show it.
        is_params, complain, remark: As for `read`.

    Raises:
        GraphFileError: As for `read`; also if the file does not exist, is not a regular one, or is not text.
    """
    try:
        data = found_bytes(path, MAX_BYTES)
    except OSError as error:
        hint = _similar_file(path) if isinstance(error, FileNotFoundError) else ""
        raise _error(Place(name), f"cannot be read: {error.strerror}{hint}") from None
    try:
        return read(data.decode("utf-8-sig"), name, is_params=is_params, complain=complain, remark=remark)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise _error(Place(name, line), "is not UTF-8 text; save the file as UTF-8") from None


def _similar_file(path: pathlib.Path) -> str:
    """Suggest a file of a similar name in the same folder."""
    try:
        beside = [entry.name for entry in islice(path.parent.iterdir(), SEARCHED)]
    except OSError:
        return ""
    near = nearest(path.name, [name for name in beside if name.endswith((".yaml", ".yml"))])
    return f"; did you mean {near!r}?" if near is not None else ""


def read(
    text: str,
    file: str,
    *,
    is_params: bool = False,
    complain: Complain | None = None,
    remark: Complain | None = None,
) -> Source:
    """Read one YAML document.

    Args:
        file: The file as messages show it.
        is_params: Whether to read it as ROS reads parameter files: every key is text, and mappings under the same key
            are merged.
        complain: Called with each key that is not text, which is then left out; None raises instead.
        remark: Called with each value in quotes that are none in YAML.

    Raises:
        GraphFileError: `text` is not YAML, or uses a refused feature; the first such place.
    """
    if len(text.encode(errors="replace")) > MAX_BYTES:
        raise _error(Place(file), f"the file is larger than {MAX_BYTES:,} bytes")
    unprintable = _UNPRINTABLE.search(text)
    if unprintable:
        before = text[: unprintable.start()]
        place = Place(file, before.count("\n") + 1, len(before) - before.rfind("\n"))
        raise _error(place, f"the character U+{ord(unprintable[0]):04X} is not allowed in a YAML file; delete it")
    try:
        return _Builder(text, file, is_params=is_params, complain=complain or _error_at, remark=remark).build()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        lines = text.splitlines()
        if mark and mark.line >= len(lines):  # the end of the text: point after its last character
            place = Place(file, len(lines), len(lines[-1]) + 1) if lines else Place(file, 1, 1)
        else:
            place = Place(file, mark.line + 1, mark.column + 1) if mark else Place(file)
        if "nesting depth" in str(error.problem):  # libyaml reads ahead and has a limit of its own
            raise _error(place, f"nested more than {MAX_DEPTH} deep") from None
        if mark and _WHERE_A_KEY.search(str(error.problem)) and (key := yaml_slips.unspaced_key(lines, mark.line)):
            raise _error(Place(file, *key[:2]), f"write a space after '{key[2]}:'") from None
        raise _error(place, f"not valid YAML: {error.problem}{_hint(text, error)}") from None
    except yaml.YAMLError as error:
        raise _error(Place(file), f"not valid YAML: {' '.join(str(error).split())}") from None


def _hint(text: str, error: yaml.MarkedYAMLError) -> str:
    """Return the correction for a common mistake, in parentheses; empty if none is known."""
    mark, start = error.problem_mark, error.context_mark
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
    if "cannot start any token" in problem and mark and line:
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


def _error_at(place: Place, message: str) -> NoReturn:
    raise _error(place, message)


@dataclass(slots=True)
class _Frame:
    """A mapping or list that has begun and not yet ended."""

    container: dict[str, Data] | list[Data]
    path: Path
    key: str | None = None
    """The key of a mapping whose value comes next; None before a key."""


class _Builder:
    """The values and places of a document, built from the parser's events."""

    def __init__(
        self, text: str, file: str, *, is_params: bool, complain: Complain, remark: Complain | None = None
    ) -> None:
        self._text, self._file, self._is_params = text, file, is_params
        self._complain, self._remark = complain, remark
        self._lines = _LINE_BREAK.split(text)
        self._root: list[Data] = []
        self._places: dict[Path, Place] = {}
        self._keys: dict[Path, Place] = {}
        self._stack: list[_Frame] = []
        self._refused: list[tuple[dict[str, Data], str]] = []
        """Keys that are not text, with their mappings; they are kept until the end so that their values are read."""
        self._reported: set[tuple[int, str]] = set()
        self._documents = self._count = 0

    def build(self) -> Source:
        for event in yaml.parse(self._text, Loader=_LOADER):
            mark = event.start_mark
            assert mark is not None  # the parser sets it for every event
            self._add(event, Place(self._file, mark.line + 1, mark.column + 1))
        for mapping, key in self._refused:  # only now: their values had to be put somewhere
            mapping.pop(key, None)
        if not self._root:
            self._root.append(None)
            self._places[()] = Place(self._file, 1, 1)
        return Source(self._root[0], self._places, self._keys)

    def _add(self, event: yaml.Event, place: Place) -> None:
        if isinstance(event, yaml.DocumentStartEvent):
            self._documents += 1
            if self._documents > 1:
                raise _error(place, "one document per file: remove the line '---'")
        elif isinstance(event, yaml.AliasEvent):
            raise _error(place, f"*{event.anchor}: aliases are not used here; write the value out")
        elif isinstance(event, yaml.CollectionEndEvent):
            self._stack.pop()
        elif isinstance(event, (yaml.ScalarEvent, yaml.CollectionStartEvent)):
            self._count += 1
            if self._count > MAX_VALUES:
                raise _error(place, f"the file has more than {MAX_VALUES:,} values")
            if event.tag not in (None, "!", "tag:yaml.org,2002:str"):
                written = event.tag.replace("tag:yaml.org,2002:", "!!")
                raise _error(place, f"{written}: tags are not used here; write a plain value")
            frame = self._stack[-1] if self._stack else None
            if frame is not None and isinstance(frame.container, dict) and frame.key is None:
                self._begin_entry(event, place, frame, frame.container)
            elif isinstance(event, yaml.ScalarEvent):
                if self._remark is not None and not event.style and (odd := _odd_quotes(event.value)):
                    self._remark(place, odd)
                self._put(_scalar_value(event, place), place)
            else:
                self._open({} if isinstance(event, yaml.MappingStartEvent) else [], place)

    def _begin_entry(self, event: yaml.NodeEvent, place: Place, frame: _Frame, mapping: dict[str, Data]) -> None:
        """Take an event as the key of the next entry of a mapping."""
        if not isinstance(event, yaml.ScalarEvent):
            raise _error(place, "a key must be a word, not a list or mapping")
        key, path = str(event.value), (*frame.path, str(event.value))
        if not self._is_params and (fault := _key_fault(event, place, self._lines[place.line - 1])):
            if (place.line, fault) not in self._reported:  # a list without brackets has several such keys
                self._complain(place, fault)
            self._reported.add((place.line, fault))
            self._refused.append((mapping, key))
        elif key in mapping and not (self._is_params and isinstance(mapping[key], dict)):
            raise self._twice(path, place)
        self._keys.setdefault(path, place)  # of a mapping that is continued, the first key counts
        frame.key = key

    def _open(self, container: dict[str, Data] | list[Data], place: Place) -> None:
        """Begin a mapping or list; in a parameter file, a mapping under a key that has one continues it."""
        above = self._stack[-1] if self._stack else None
        before = None
        if above is not None and isinstance(above.container, dict) and above.key is not None:
            before = above.container.get(above.key)
        if above is not None and above.key is not None and isinstance(before, dict) and isinstance(container, dict):
            container, path, above.key = before, (*above.path, above.key), None
        else:
            path = self._put(container, place)
        self._stack.append(_Frame(container, path))
        if len(self._stack) > MAX_DEPTH:
            raise _error(place, f"nested more than {MAX_DEPTH} deep")

    def _put(self, value: Data, place: Place) -> Path:
        """Add a value to the innermost open container; returns its path."""
        if not self._stack:
            self._root.append(value)
            self._places[()] = place
            return ()
        frame = self._stack[-1]
        container, path = frame.container, frame.path
        if isinstance(container, list):
            path = (*path, len(container))
            container.append(value)
        else:
            key = frame.key
            assert key is not None
            path = (*path, key)
            if key in container and not any(one is container and name == key for one, name in self._refused):
                raise self._twice(path, place)
            container[key] = value
            frame.key = None
        self._places[path] = place
        return path

    def _twice(self, path: Path, place: Place) -> GraphFileError:
        first = self._keys[path].line
        way = f"for two nodes, give one another name, such as {path[-1]}2; else remove one"
        way = way if path[:-1] == ("nodes",) else "remove one"
        return _error(place, f"the key {path[-1]!r} appears twice, first on line {first}; {way}")


def _key_fault(event: yaml.ScalarEvent, place: Place, line: str) -> str:
    """Return why a key is not text, and the correction; empty for a valid key."""
    if not event.style and is_quoted(event.value):
        return f"{event.value[0]} and {event.value[-1]} are not quotes in YAML; write {plain(event.value)}"
    if not event.style and (slip := yaml_slips.of_key(event.value, line)):
        return slip
    if event.style or isinstance(_scalar_value(event, place), str):
        return ""
    column = place.column - 1
    if found := _KEYS_ONLY.search(line):
        return f"values have names: {{name: {found[1]}, ...}}"
    before = _COMMA.search(line[:column])
    if before and event.value.isdecimal():
        return f"a number is written with a point: {before[1]}.{event.value}, not {before[1]},{event.value}"
    if slip := yaml_slips.of_number(line, column):
        return slip
    return f"the key {event.value} is not text; write it in quotes: '{event.value}'"


def _odd_quotes(text: str) -> str:
    """Return a remark on a text in typographic quotes; empty for others, as for several quoted words."""
    if not is_quoted(text) or {text[0], text[-1]} & {*text[1:-1]}:
        return ""
    ways = [plain(text)] if plain(text)[0] not in text else []
    ways += [f"'{text}' to keep them"] if "'" not in text else []
    way = f"; write {', or '.join(ways)}" if ways else ""
    return f"{text[0]} and {text[-1]} are not quotes in YAML, and are part of the value{way}"


def _scalar_value(event: yaml.ScalarEvent, place: Place) -> Scalar:
    if event.style or event.tag is not None:  # only the tags ! and !!str get this far, and both mean text
        return str(event.value)
    try:
        return scalar(event.value)
    except ValueError:
        raise _error(place, f"{event.value[:20]}... has too many digits for a number; put text in quotes") from None


def parse_value(text: str) -> Data:
    """Parse a YAML value from the command line: `200`, `true`, `{x: 1.0}`.

    Raises:
        GraphflowError: `text` is not YAML; the message says where.
    """
    try:
        return read(text, "value").data
    except GraphFileError as error:
        problem = error.problems[0]
        raise GraphflowError(f"{text!r}, character {problem.place.column}: {problem.message}") from None
