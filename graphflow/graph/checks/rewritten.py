"""Corrections of values in the form of other tools: a list of pairs, a line of a shell.

params: [{rate: 2.0}]                    ->   params: {rate: 2.0}          (launch files in Python)
env: [DISPLAY=:0]                        ->   env: {DISPLAY: ":0"}         (docker-compose)
remap: [{from: chatter, to: news}]       ->   remap: {chatter: news}       (launch files in XML and YAML)
command: cd /tmp && ls                   ->   command: [sh, -c, cd /tmp && ls]
request: "{x: 1.0}"                      ->   request: {x: 1.0}            (the command line)
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Mapping, Sequence

import yaml

from graphflow.errors import GraphflowError

MAX_SHOWN = 120
"""Length in characters of a line that is shown; a longer one would hide the message around it."""
_MAPPINGS = ("params", "remap", "env", "args", "request")
_PAIR = re.compile(r"([^\s=:]+)(?::=|=|: *| *-> *)(.*)", re.DOTALL)
"""A name and a value in one word."""
_NAMES = ("name", "from", "key")
_VALUES = ("value", "to", "default")
_SHELL_WORDS = frozenset(("&&", "||", "|", ">", ">>", "<", "2>", "2>&1", ";", "&"))
"""Words of shell syntax."""
_OF_THEIR_OWN = frozenset(("expr", "test", "[", "find", "xargs", "jq", "awk", "sed", "grep"))
"""Programs that take such words as arguments."""
_BUILT_IN = frozenset(("cd", "source", ".", "export", "alias", "ulimit", "unset"))
"""Builtin commands of shells."""
_IN_A_LINE = re.compile(r"&&|\|\||[|<>;]|\s&\s*$")


def line_for(key: str, value: object) -> str:
    """Return the corrected line for a value; empty if none is known, or if it is too long to show.

    Args:
        key: The key of the value.
    """
    if (inner := _within_quotes(value)) and (line := _line_within(key, inner)):
        return f"{line}, without quotes"
    made: Mapping[str, object] | None = None
    if key in _MAPPINGS:
        made = _mapping(value)
    elif key == "nodes" and isinstance(value, list):
        made = _by_name(value)
    elif key == "command" and isinstance(value, str):
        return f"command: {command_of(value)}"
    elif key in ("wait", "goal", "call") and isinstance(value, dict) and value:
        key, made = "request", value
    elif key == "wait" and isinstance(value, (int, float)) and not isinstance(value, bool):
        return f"delay: {value}"
    return _shortened(key, made) if made else ""


def _shortened(key: str, made: Mapping[str, object]) -> str:
    """Return a mapping under a key as one line, if need be with its first entry only; empty if that is too long."""
    line = f"{key}: {flow(made)}"
    if len(line) > MAX_SHOWN and len(made) > 1:
        line = f"{key}: {flow(dict([next(iter(made.items()))]))[:-1]}, ...}}"
    return line if len(line) <= MAX_SHOWN else ""


def _within_quotes(value: object) -> dict[str, object] | list[object] | None:
    """Parse a text that is a mapping or list in quotes; None for any other value."""
    from graphflow.markup.source import parse_value

    if not isinstance(value, str) or not value.lstrip().startswith(("{", "[")):
        return None
    try:
        inner = parse_value(value)
    except GraphflowError:
        return None
    return inner if isinstance(inner, (dict, list)) else None  # type: ignore[return-value]


def _line_within(key: str, inner: dict[str, object] | list[object]) -> str:
    """Return the line for a value that was in quotes."""
    if isinstance(inner, dict):
        return _shortened(key, inner)
    if key != "command":
        return line_for(key, inner)
    line = f"command: {flow(inner)}"
    return line if len(line) <= MAX_SHOWN else ""


def flow(value: object) -> str:
    """Return a mapping or list as YAML on one line."""
    return str(yaml.safe_dump(value, default_flow_style=True, width=10**6, sort_keys=False, allow_unicode=True)).strip()


def command_of(line: str) -> str:
    """Return a command line as a YAML list, which calls a shell if the line needs one."""
    try:
        words = shlex.split(line)
    except ValueError:  # a quote that is not closed
        words = line.split()
    needs_shell = words[:1] and (words[0] in _BUILT_IN or _IN_A_LINE.search(line))
    return flow(["sh", "-c", line] if needs_shell else words)


def shell_word(words: Sequence[object]) -> str:
    """Return the first word of a command that is shell syntax; empty if there is none, or if the program takes it."""
    program = str(words[0]).rpartition("/")[2] if words else ""
    if program in _OF_THEIR_OWN:
        return ""
    return program if program in _BUILT_IN else next((str(word) for word in words if word in _SHELL_WORDS), "")


def in_shell(words: Sequence[object]) -> str:
    """Return the command line that runs a command in a shell."""
    texts = [str(word) if word in _SHELL_WORDS else shlex.quote(str(word)) for word in words]
    return flow(["sh", "-c", " ".join(texts)])


def _mapping(value: object) -> dict[str, object] | None:
    """Convert a list of pairs to a mapping; None for any other value."""
    found: dict[str, object] = {}
    for one in value if isinstance(value, list) else [value]:
        pairs = list(_pairs(one))
        if not pairs:
            return None
        found.update(pairs)
    return found


def _pairs(one: object) -> Iterator[tuple[str, object]]:
    match one:
        case str() if (pair := _PAIR.fullmatch(one)) is not None:
            yield pair[1], _plain(pair[2])
        case [str() as name, str() | int() | float() as value]:
            yield name, value
        case dict():
            named = next((key for key in _NAMES if isinstance(one.get(key), str)), None)
            key = next((key for key in _VALUES if key in one), None)
            if named is not None and key is not None:
                yield one[named], one[key]
            elif not one.keys() & {*_NAMES, *_VALUES}:
                yield from one.items()


def _plain(text: str) -> object:
    """Return the YAML scalar of a text."""
    from graphflow.markup.source import scalar

    try:
        return scalar(text)
    except ValueError:
        return text


def _by_name(nodes: list[object]) -> dict[str, object] | None:
    """Return a list of nodes as a mapping by their names; None if one has no name."""
    found: dict[str, object] = {}
    for node in nodes:
        match node:
            case {"name": str() as name, **others}:
                found[f"/{name.lstrip('/')}"] = others
            case dict() if len(node) == 1 and isinstance(next(iter(node.values())), dict):
                found |= node
            case _:
                return None
    return found
