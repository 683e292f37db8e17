"""Command lines of ROS in launch files, as steps: `ros2 service call`, `ros2 action send_goal`, `ros2 param set`."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Sequence

from graphflow.errors import GraphFileError, Place
from graphflow.launchfiles.attributes import split
from graphflow.markup import source
from graphflow.markup.tree import Item, located, tree

Complain = Callable[[Place, str], None]


def plain_words(line: str) -> list[str]:
    """The words of a line for a shell, if it needs none: no pipes and the like; else no words."""
    try:
        return split(line, _plain)
    except ValueError:
        return []


def _plain(line: str) -> list[str]:
    reader = shlex.shlex(line, posix=True, punctuation_chars=";|&<>")
    reader.whitespace_split = True
    reader.commenters = ""
    words = list(reader)
    return [] if any(word and not word.strip(";|&<>") for word in words) else words


def one_word_fault(texts: Sequence[str]) -> str:
    """What to write for a command whose only word is a whole line; empty for others, as a program with a space."""
    if len(texts) != 1 or os.path.exists(texts[0]):
        return ""
    words = plain_words(texts[0])
    if len(words) == 1 or not texts[0].strip():
        return ""
    way = f", cmd={words}" if words and "$(" not in texts[0] else ""
    return f"cmd is one word with spaces: add shell=True{f', or give a list of words{way}' if words else ''}"


def step_of(words: Sequence[str], command: Item, complain: Complain) -> dict[str, Item] | None:
    """A step in place of a command line; None if it is another program's.

    Args:
        command: Where the line is written.
        complain: Called with what is wrong with a request.
    """
    match words:
        case ["ros2", "service", "call", name, type_, *values]:
            return _sent("call", name, type_, values, command, complain)
        case ["ros2", "action", "send_goal", name, type_, *values]:
            fields = [value for value in values if not value.startswith("-")]
            return _sent("goal", name, type_, fields, command, complain)
        case ["ros2", "param", "set", node, parameter, value]:
            params = Item({parameter: typed(Item(value, command.place))}, command.place)
            found = {"set": Item(node, command.place), "params": params}
            return {**found, "type": Item("rcl_interfaces/srv/SetParametersAtomically", command.place)}
    return None


def _sent(
    deed: str, name: str, type_: str, values: Sequence[str], command: Item, complain: Complain
) -> dict[str, Item]:
    found = {deed: Item(name, command.place), "type": Item(type_, command.place)}
    text = " ".join(values)
    if text:
        try:
            data = source.read(text, command.place.file).data
            if isinstance(data, str):  # it had quotes for a shell around it
                data = source.read(data, command.place.file).data
        except GraphFileError as error:
            complain(command.place, f"the request {text[:60]!r}: {error.problems[0].message}")
            return found
        found["request"] = located(data, command.place)
    return found


def typed(item: Item) -> Item:
    """A text as what it reads as in YAML: launch files have nothing but texts."""
    if not isinstance(item.value, str) or "$(" in item.value:
        return item
    try:
        read = tree(source.read(item.value, item.place.file))
    except GraphFileError:
        return item
    if isinstance(read.value, dict) or read.value is None:
        return item
    return located(read.plain(), item.place)._replace(key=item.key)
