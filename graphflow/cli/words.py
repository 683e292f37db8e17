"""Splitting a command line into options and values, where values may look like options.

`graphflow topic pub -r 10 /cmd_vel geometry_msgs/msg/Twist {linear: {x: -2.0}} -1` comes from the shell as many words.
A word is an option when it is written as one of the command's options (`-r10` too), stands outside all brackets and
not after a field's colon; everything else is a value, and the values of a message are joined again.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import click

from graphflow.errors import GraphflowError

F = TypeVar("F", bound=Callable[..., Any])

_QUOTED = re.compile(r"""(?<!\w)("(?:\\.|[^"\\])*"|'[^']*')""")
_TIGHT = re.compile(r"\w:\S")
_BETWEEN_DOCUMENTS = re.compile(r"^---(?=\s|\Z)", re.MULTILINE)
"""Nothing else begins a line so, not even in a text of several lines: YAML 1.2.2, section 9.1.2."""
_IS_SAID = re.compile(r"^\s*[^\s#]", re.MULTILINE)
"""Something other than a comment."""
_WITH_NUMBER = re.compile(r"(-[A-Za-z])\d+(\.\d*)?\Z")


def split_values(words: Sequence[str], flags: frozenset[str], valued: frozenset[str]) -> list[str]:
    """The same words in the order click wants: options first, then `--`, then everything that is a value.

    Args:
        flags: Options without a value.
        valued: Options with one.
    """
    options: list[str] = []
    values: list[str] = []
    rest = list(words)
    while rest:
        word = rest.pop(0)
        name, equals, _ = word.partition("=")
        numbered = _WITH_NUMBER.match(word)
        if _is_open(values):
            values.append(word)
        elif word in flags or (equals and name in valued) or (numbered and numbered[1] in valued):
            options.append(word)
        elif word in valued:
            options += [word, *rest[:1]]
            rest = rest[1:]
        elif word == "--":
            values += rest
            break
        elif word.startswith("--") and len(word) > 2:
            options.append(word)  # click says what is wrong with it
        else:
            values.append(word)
    return [*options, "--", *values]


def _is_open(values: list[str]) -> bool:
    """Whether the next word belongs to `values`: a bracket is open, or a field waits for its value."""
    text = _QUOTED.sub("", " ".join(values))
    brackets = sum(text.count(c) for c in "{[") - sum(text.count(c) for c in "}]")
    return brackets > 0 or text.endswith(":")


class ValueCommand(click.Command):
    """A command whose values may begin with a minus sign, and whose options may be anywhere."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        flags, valued = {"--help", "-h"}, set[str]()
        for parameter in self.params:
            if isinstance(parameter, click.Option):
                (flags if parameter.is_flag or parameter.count else valued).update(parameter.opts)
                flags.update(parameter.secondary_opts)
        return super().parse_args(ctx, split_values(args, frozenset(flags), frozenset(valued)))


def pattern_option(_: click.Context, __: click.Parameter, value: str) -> str:
    """A regular expression; as a callback of an option."""
    try:
        re.compile(value)
    except re.error as error:
        raise click.BadParameter(f"{value!r} is no regular expression: {error}") from None
    return value


def stdin_option(command: F) -> F:
    """Add `--stdin` to a command that takes a message."""
    option = click.option("--stdin", "from_stdin", is_flag=True, help="Read the values from standard input.")
    return option(command)


def message_values(words: Sequence[str], *, from_stdin: bool = False) -> Any:
    """The values of a message from the words after its type, or from standard input; None for none.

    Raises:
        UsageFault: The words are not YAML, or a missing space keeps them from being a mapping.
    """
    from graphflow.errors import UsageFault
    from graphflow.graph.source import parse_value

    if words and from_stdin:
        raise UsageFault(f"--stdin reads the values from standard input; leave out {words[0]!r}")
    text = sys.stdin.read() if from_stdin else " ".join(words)
    try:
        values = parse_value(text)
    except GraphflowError as error:
        raise UsageFault(str(error)) from None
    keys = [values] if isinstance(values, str) else values if isinstance(values, dict) else []
    if any(_TIGHT.search(key) for key in keys):
        raise UsageFault(f"{text!r}: write a space after each colon and quotes around all, for example '{{x: 2.0}}'")
    return values


def messages_in(file: Path) -> list[tuple[str, Any]]:
    """The values of the messages in a file, each with its place there: documents of YAML, as `topic echo` prints them.

    Raises:
        UsageFault: It cannot be read, has no message, or one of its documents is not YAML.
    """
    from graphflow.errors import GraphFileError, UsageFault
    from graphflow.graph.source import read

    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UsageFault(f"{file}: {getattr(error, 'strerror', None) or 'is not UTF-8 text'}") from None
    found, line = [], 0
    for document in _BETWEEN_DOCUMENTS.split(text):
        if _IS_SAID.search(document):
            first = line + document[: len(document) - len(document.lstrip())].count("\n") + 1
            try:
                found.append((f"{file}:{first}", read("\n" * line + document, str(file)).data))
            except GraphFileError as error:
                raise UsageFault(str(error)) from None
        line += document.count("\n")
    if not found:
        raise UsageFault(f"{file} has no message; graphflow topic echo TOPIC > {file} writes some")
    return found
