"""ROS's launch files in XML, read as trees of the YAML dialect: lists of actions with their attributes.

    <node pkg="p" exec="e"><param name="a" value="1"/></node>   ->   {node: {pkg: p, exec: e, param: [{name: a, ...}]}}

Source: launch_xml, "Entity"; design article "ROS 2 Launch XML Format".
"""

from __future__ import annotations

import pathlib
import re
from dataclasses import dataclass, field
from xml.parsers import expat

from graphflow.errors import GraphFileError, Place, Problem
from graphflow.markup.param_types import from_yaml
from graphflow.markup.ros1_words import action
from graphflow.markup.source import MAX_BYTES, MAX_DEPTH, Data
from graphflow.markup.tree import Item, located
from graphflow.reading import found_bytes
from graphflow.typographic import plain

_WITH_ACTIONS = ("launch", "group", "timer", "ros_timer")


def read_file(path: pathlib.Path, name: str) -> Item:
    """Read a launch file.

    Args:
        name: The file as messages show it.

    Raises:
        GraphFileError: The file cannot be read, is not XML, or is refused: it declares entities, or is too large.
    """
    try:
        data = found_bytes(path, MAX_BYTES)
    except OSError as error:
        raise _error(Place(name), f"cannot be read: {error.strerror}") from None
    return _Reader(name).read(data)


_NO_QUOTES = re.compile(r"\s([\w-]+)\s*=\s*([^\s\"'/>]+)")
"""An attribute whose value has no quotes."""


@dataclass
class _Element:
    """An element that has begun and not yet ended."""

    name: str
    attributes: dict[str, Item]
    place: Place
    children: list[tuple[str, Item]] = field(default_factory=list)
    """Names and attributes of the elements within it."""


class _Reader:
    """The state of expat's parser and its handlers."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._parser = expat.ParserCreate()
        self._open: list[_Element] = []
        """The open elements, the outermost first."""
        self._top: Item | None = None

    def read(self, data: bytes) -> Item:
        self._parser.StartElementHandler = self._begin
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._text
        # Entities are declared there: without them, a small file cannot grow without end.
        self._parser.StartDoctypeDeclHandler = self._refuse
        try:
            self._parser.Parse(data, True)
        except expat.ExpatError as error:
            text = expat.ErrorString(error.code) + self._hint(error, data)
            raise _error(Place(self._name, error.lineno, error.offset + 1), f"not valid XML: {text}") from None
        assert self._top is not None
        return self._top

    def _hint(self, error: expat.ExpatError, data: bytes) -> str:
        """Return a correction for a common mistake; empty if none is known."""
        lines = data.decode(errors="replace").splitlines()
        line = lines[error.lineno - 1] if error.lineno <= len(lines) else ""
        if plain(line) != line and "token" in expat.ErrorString(error.code):
            return f"; write the quotes of the keyboard: {plain(line).strip()[:80]}"
        if bare := _NO_QUOTES.search(line):
            return f'; write quotes: {bare[1]}="{bare[2]}"'
        if self._open and "tag" in expat.ErrorString(error.code):
            name, begin = self._open[-1].name, self._open[-1].place.line
            return f"; <{name}> of line {begin} is not closed: end it with /> or </{name}>"
        return ""

    @property
    def _place(self) -> Place:
        return Place(self._name, self._parser.CurrentLineNumber, self._parser.CurrentColumnNumber + 1)

    def _begin(self, name: str, attributes: dict[str, str]) -> None:
        place = self._place
        if not self._open and name != "launch":
            raise _error(place, f"a launch file's outermost element is <launch>, not <{name}>")
        if len(self._open) >= MAX_DEPTH:
            raise _error(place, f"nested more than {MAX_DEPTH} deep")
        values = {key: Item(value, place, place) for key, value in attributes.items()}
        self._open.append(_Element(name, values, place))

    def _end(self, _name: str) -> None:
        element = self._open.pop()
        item = Item(element.attributes, element.place, element.place)
        if element.name == "param" and "value" in element.attributes:
            item = _with_type(item)
        if element.name in _WITH_ACTIONS:
            actions = [Item({name: child}, child.place) for name, child in element.children if name != "keep"]
            item = item.with_value({**item.entries, "children": Item(actions, item.place, item.key)})
        else:
            item = item.with_value({**item.entries, **_lists(element.children, item.entries)})
        if self._open:
            self._open[-1].children.append((element.name, item))
        else:
            self._top = Item({"launch": item.entries["children"]}, item.place)

    def _text(self, text: str) -> None:
        if text.strip() and self._open:
            name, attributes = self._open[-1].name, self._open[-1].attributes
            if name == "param" and "name" in attributes:
                way = f'<param name="{attributes["name"].value}" value="{text.strip()[:40]}"/>'
                raise _error(self._open[-1].place, f"<param> has no text inside: write {way}")
            if former := action(name):
                raise _error(self._open[-1].place, f"<{name}> {former}")
            raise _error(self._place, f"{text.strip()[:40]!r}: text between elements means nothing; use an attribute")

    def _refuse(self, *_: object) -> None:
        raise _error(self._place, "<!DOCTYPE> is not used here; remove it")


def _lists(children: list[tuple[str, Item]], attributes: dict[str, Item]) -> dict[str, Item]:
    """Return the elements within another as its list attributes."""
    found: dict[str, Item] = {}
    for name, child in children:
        before = found.get(name, attributes.get(name, Item([], child.place, child.key)))
        found[name] = before.with_value([*before.items, child])
    return found


def _with_type(param: Item) -> Item:
    """Convert the value of a parameter, which in XML is always a text, to that of the YAML dialect."""
    entries = param.without("value-sep").entries
    item, separator = entries["value"], param.entries.get("value-sep")
    is_typed = "type" in entries
    value: Data
    if separator is not None:
        value = [part if is_typed else _read(part) for part in str(item.value).split(str(separator.value) or None)]
    else:
        value = str(item.value) if is_typed else _read(str(item.value))
    return param.with_value({**entries, "value": located(value, item.place).with_key(item.key)})


def _read(text: str) -> Data:
    """Parse a text as YAML; one with substitutions only if it is quoted or a list."""
    return text if "$(" in text and text[:1] not in ("'", '"', "[") else from_yaml(text)


def _error(place: Place, message: str) -> GraphFileError:
    return GraphFileError([Problem(place, message)])
