"""ROS's launch files in XML, read as the YAML dialect has them: a list of actions with their attributes.

    <node pkg="p" exec="e"><param name="a" value="1"/></node>   ->   {node: {pkg: p, exec: e, param: [{name: a, ...}]}}

Source: launch_xml, "Entity"; design article "ROS 2 Launch XML Format".
"""

from __future__ import annotations

import pathlib
import re
from typing import Any
from xml.parsers import expat

from graphflow.errors import GraphFileError, Place, Problem
from graphflow.markup.param_types import from_yaml
from graphflow.markup.ros1_words import action
from graphflow.markup.source import MAX_BYTES, MAX_DEPTH
from graphflow.markup.tree import Item, located
from graphflow.reading import found_bytes
from graphflow.typographic import plain

LISTS = ("param", "remap", "env", "arg", "choice", "composable_node", "extra_arg", "keep", "let")
"""Elements that are attributes of the one around them, as lists; any other in it is an action."""
_WITH_ACTIONS = ("launch", "group", "timer", "ros_timer")


def read_file(path: pathlib.Path, name: str) -> Item:
    """A launch file.

    Args:
        name: The file as messages show it.

    Raises:
        GraphFileError: It cannot be read, is no XML, or has what is refused here: entities of its own, great size.
    """
    try:
        data = found_bytes(path, MAX_BYTES)
    except OSError as error:
        raise _error(Place(name), f"cannot be read: {error.strerror}") from None
    return _Reader(name).read(data)


_NO_QUOTES = re.compile(r"\s([\w-]+)\s*=\s*([^\s\"'/>]+)")
"""An attribute whose value stands without quotes."""


class _Reader:
    def __init__(self, name: str) -> None:
        self._name = name
        self._parser = expat.ParserCreate()
        self._open: list[tuple[str, Item, list[Item]]] = []
        """Elements under way: the name, the attributes, the children."""
        self._top: Item | None = None

    def read(self, data: bytes) -> Item:
        self._parser.StartElementHandler = self._begin
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._text
        self._parser.StartDoctypeDeclHandler = self._refuse
        try:
            self._parser.Parse(data, True)
        except expat.ExpatError as error:
            text = expat.ErrorString(error.code) + self._hint(error, data)
            raise _error(Place(self._name, error.lineno, error.offset + 1), f"not valid XML: {text}") from None
        assert self._top is not None
        return self._top

    def _hint(self, error: expat.ExpatError, data: bytes) -> str:
        """A correction, as far as the mistake shows it."""
        lines = data.decode(errors="replace").splitlines()
        line = lines[error.lineno - 1] if error.lineno <= len(lines) else ""
        if plain(line) != line and "token" in expat.ErrorString(error.code):
            return f"; write the quotes of the keyboard: {plain(line).strip()[:80]}"
        if bare := _NO_QUOTES.search(line):
            return f'; write quotes: {bare[1]}="{bare[2]}"'
        if self._open and "tag" in expat.ErrorString(error.code):
            name, attributes, _ = self._open[-1]
            return f"; <{name}> of line {attributes.place.line} is not closed: end it with /> or </{name}>"
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
        self._open.append((name, Item(values, place, place), []))

    def _end(self, name: str) -> None:
        name, attributes, children = self._open.pop()
        if name == "param" and "value" in attributes.value:
            attributes = _with_type(attributes)
        if name in _WITH_ACTIONS:
            lists = [child for child in children if next(iter(child.value)) == "keep"]
            actions = [child for child in children if child not in lists]
            attributes.value["children"] = Item(actions, attributes.place, attributes.key)
        else:
            for child in children:
                [(kind, item)] = child.value.items()
                attributes.value.setdefault(kind, Item([], item.place, item.key)).value.append(item)
        action = Item({name: attributes}, attributes.place)
        if self._open:
            self._open[-1][2].append(action)
        else:
            self._top = Item({"launch": attributes.value["children"]}, attributes.place)

    def _text(self, text: str) -> None:
        if text.strip() and self._open:
            name, attributes, _ = self._open[-1]
            if former := action(name):
                raise _error(attributes.place, f"<{name}> {former}")
            raise _error(self._place, f"{text.strip()[:40]!r}: text between elements means nothing; use an attribute")

    def _refuse(self, *_: Any) -> None:
        raise _error(self._place, "<!DOCTYPE> is not used here; remove it")


def _with_type(param: Item) -> Item:
    """A parameter with its value as the YAML dialect has it: in XML all are texts."""
    entries = param.without("value-sep").entries
    item, separator = entries["value"], param.entries.get("value-sep")
    is_typed = "type" in entries
    if separator is not None:
        value = [part if is_typed else _read(part) for part in str(item.value).split(str(separator.value) or None)]
    else:
        value = item.value if is_typed else _read(item.value)
    return param._replace(value={**entries, "value": located(value, item.place)._replace(key=item.key)})


def _read(text: str) -> Any:
    """A text as what it reads as in YAML; one with substitutions only if they stand in quotes or in a list."""
    return text if "$(" in text and text[:1] not in ("'", '"', "[") else from_yaml(text)


def _error(place: Place, message: str) -> GraphFileError:
    return GraphFileError([Problem(place, message)])
