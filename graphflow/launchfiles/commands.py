"""Conversion of command lines to steps: `ros2 service call`, `ros2 action send_goal` and `ros2 param set`."""

from __future__ import annotations

import os
import shlex
from collections.abc import Sequence

from graphflow.errors import GraphFileError
from graphflow.launchfiles.attributes import split
from graphflow.markup import source
from graphflow.markup.source import Complain
from graphflow.markup.tree import Item, located, tree


def plain_words(line: str) -> list[str]:
    """Split a shell command without pipes or redirections into words; empty for any other."""
    try:
        return split(line, _plain)
    except ValueError:
        return []


def _plain(line: str) -> list[str]:
    reader = shlex.shlex(line, posix=True, punctuation_chars=";|&<>")
    # Else shlex ends a word at each character that it does not expect in one, such as : and {.
    reader.whitespace_split = True
    reader.commenters = ""  # as in `shlex.split`
    words = list(reader)
    return [] if any(word and not word.strip(";|&<>") for word in words) else words


def one_word_fault(texts: Sequence[str]) -> str:
    """Return the fault of a command whose only word is a whole line; empty if a program has that name."""
    if len(texts) != 1 or os.path.exists(texts[0]):
        return ""
    words = plain_words(texts[0])
    if len(words) == 1 or not texts[0].strip():
        return ""
    way = f", cmd={words}" if words and "$(" not in texts[0] else ""
    return f"cmd is one word with spaces: add shell=True{f', or give a list of words{way}' if words else ''}"


def step_of(words: Sequence[str], command: Item, complain: Complain) -> dict[str, Item] | None:
    """Convert a command line of `ros2` to a step; None for other commands.

    Args:
        command: The item with the command line.
        complain: Called with the fault of a request.
    """
    match words:
        case ["ros2", "service", "call", name, type_, *values]:
            return _sent("call", name, type_, values, command, complain)
        case ["ros2", "action", "send_goal", name, type_, *values]:
            # Options such as --feedback are for the terminal.
            fields = [value for value in values if not value.startswith("-")]
            return _sent("goal", name, type_, fields, command, complain)
        case ["ros2", "param", "set", node, parameter, value]:
            params = Item({parameter: typed(Item(value, command.place))}, command.place)
            found = {"set": Item(node, command.place), "params": params}
            return {**found, "type": Item("rcl_interfaces/srv/SetParametersAtomically", command.place)}
    return None


def _sent(key: str, name: str, type_: str, values: Sequence[str], command: Item, complain: Complain) -> dict[str, Item]:
    found = {key: Item(name, command.place), "type": Item(type_, command.place)}
    text = " ".join(values)
    if text:
        try:
            data = source.read(text, command.place.file).data
            if isinstance(data, str):  # the quotes of a shell were around it
                data = source.read(data, command.place.file).data
        except GraphFileError as error:
            complain(command.place, f"the request {text[:60]!r}: {error.problems[0].message}")
            return found
        found["request"] = located(data, command.place)
    return found


def typed(item: Item) -> Item:
    """Convert a text to the YAML value that it reads as; texts with substitutions, and mappings, stay texts."""
    if not isinstance(item.value, str) or "$(" in item.value:
        return item
    try:
        read = tree(source.read(item.value, item.place.file))
    except GraphFileError:
        return item
    if isinstance(read.value, dict) or read.value is None:
        return item
    return located(read.plain(), item.place).with_key(item.key)
