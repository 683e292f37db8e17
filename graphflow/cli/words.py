"""Split a command line into options and values, where values may look like options.

`graphflow topic pub -r 10 /cmd_vel geometry_msgs/msg/Twist {linear: {x: -2.0}} -1` arrives as many words.
A word is an option if it is spelled as one of the command's options (`-r10`, too), is outside all brackets and does not
follow a field's colon; everything else is a value, and the values of a message are joined again.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

import click

from graphflow.cli.output import talk
from graphflow.errors import GraphflowError
from graphflow.reading import found_text
from graphflow.typographic import is_quoted, plain

F = TypeVar("F", bound=Callable[..., object])

_QUOTED = re.compile(r"""(?<!\w)("(?:\\.|[^"\\])*"|'[^']*')""")
_TIGHT = re.compile(r"\w:\S")
_REPAIRS = (
    (re.compile(r"(?<=\w)'(?=\w)"), "''"),
    (re.compile(r";(?=\s*\w+:\s)"), ","),
    (re.compile(r",\s*\{(?=\w+:\s)"), ", "),
    (re.compile(r"\}(?=\s*,\s*\w+:\s)"), ""),
    (re.compile(r"\}\s*,\s*\{(?=\w+:\s)"), ", "),
    (re.compile(r"(\w+:)\s+(\w+:\s+[^\s{}:,]+)"), r"\1 {\2}"),
    (re.compile(r"(?<=\w):(?=[^\s/])"), ": "),
    (re.compile(r"(?<=\w)\s*=\s*(?=[^\s=])"), ": "),
    (re.compile(r"(?<=\d),(?=\d)"), "."),
    (re.compile(r"(?<=[\w.}\]'\"])\s+(?=\w+:\s)"), ", "),
)
"""Mistakes in the values of a message, and corrections: `{x: 'it's'}`, `{x: 1; y: 2}`, `{p: {x: 1}, {q: {y: 2}}`,
`{p: {x: 1}}, q: {y: 2}`, `{p: {x: 1}}, {q: {y: 2}}`, `{p: x: 1}`, `{x:1}`, `{x=1}`, `{x: 1,5}`, `{x: 1 y: 2}`."""
_BETWEEN_DOCUMENTS = re.compile(r"^---(?=\s|\Z)", re.MULTILINE)
"""The separator of documents; even a multi-line text cannot contain such a line: YAML 1.2.2, section 9.1.2."""
_CONTENT = re.compile(r"^\s*[^\s#]", re.MULTILINE)
"""Anything but a comment."""
_MESSAGES_BOUND = 1 << 30
"""Most bytes of a file of messages; recorded output of `topic echo` can be long."""
_WITH_NUMBER = re.compile(r"(-[A-Za-z])\d+(\.\d*)?\Z")


def split_values(words: Sequence[str], flags: frozenset[str], valued: frozenset[str]) -> list[str]:
    """Reorder words for click: options first, then `--`, then all values.

    Args:
        flags: Options that take no value.
        valued: Options that take one.

    Raises:
        NoSuchOption: A word is a long option with one dash too few.
    """
    options: list[str] = []
    values: list[str] = []
    rest = list(words)
    while rest:
        word = rest.pop(0)
        name, equals, _ = word.partition("=")
        numbered = _WITH_NUMBER.match(word)
        if _is_open(values):  # inside a message even `-1` and `-r` are values
            values.append(word)
        elif word in flags or (equals and name in valued) or (numbered and numbered[1] in valued):
            options.append(word)
        elif f"-{word}" in flags | valued and len(word) > 2:  # `-once`; click would read it as `-o -n -c -e`
            raise click.NoSuchOption(word, possibilities=[f"-{word}"])
        elif word in valued:
            options += [word, *rest[:1]]
            rest = rest[1:]
        elif word == "--":
            values += rest
            break
        elif word.startswith("--") and len(word) > 2:
            options.append(word)  # unknown: click reports it
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
        words = split_values(args, frozenset(flags), frozenset(valued))
        last = words[words.index("--") - 1] if words[0] != "--" else ""
        if last in valued and args[-1] == last:
            raise click.BadOptionUsage(last, f"Option {last!r} requires an argument.", ctx)
        return super().parse_args(ctx, words)


def pattern_option(_: click.Context, __: click.Parameter, value: str) -> str:
    """Check that an option's value is a regular expression; a callback for click."""
    try:
        re.compile(value)
    except re.error as error:
        raise click.BadParameter(f"{value!r} is not a regular expression: {error}") from None
    return value


def stdin_option(command: F) -> F:
    """Add `--stdin` to a command that takes a message."""
    option = click.option("--stdin", "from_stdin", is_flag=True, help="Read the values from standard input.")
    return option(command)


def message_values(words: Sequence[str], *, from_stdin: bool = False) -> object:
    """Read the values of a message from the words after its type or from standard input; None if there are none.

    Raises:
        UsageFault: The words are not YAML, or a missing space keeps them from being a mapping.
    """
    from graphflow.errors import UsageFault
    from graphflow.markup.source import parse_value

    if words and from_stdin:
        raise UsageFault(f"--stdin reads the values from standard input; leave out {words[0]!r}")
    text = sys.stdin.read() if from_stdin else " ".join(words)
    try:
        values = parse_value(text)
    except GraphflowError as error:
        whole = next((n for n in range(1, len(words)) if _is_closed(" ".join(words[:n]))), None)
        if whole is not None:
            message = " ".join(words[:whole])
            raise UsageFault(f"{words[whole]!r} is one word too many: {message!r} is complete") from None
        if (lists := _lists(words)) is not None:
            return lists
        meant = repair(text)
        raise UsageFault(f"{text!r} is not valid YAML; did you mean {meant!r}?" if meant else str(error)) from None
    keys = [values] if isinstance(values, str) else values if isinstance(values, dict) else []
    if any(_TIGHT.search(key) for key in keys):
        raise UsageFault(f"{text!r}: write a space after each colon and quotes around it all, for example '{{x: 2.0}}'")
    if isinstance(values, str) and _is_message(values):
        raise UsageFault(f"{text!r} is a string because of its inner quotes; did you mean {values!r}?")
    if not _has_fields(values) and (meant := repair(text)):
        raise UsageFault(f"{text!r} has a key that cannot be the name of a field; did you mean {meant!r}?")
    if not from_stdin and (name := _emptied(values, text)):
        why = "the shell removes double quotes within double quotes"
        raise UsageFault(f"{text!r}: {name} has no value, since {why}; write {name}: ''")
    if odd := next(_quoted_in(values), ""):
        talk(f"note: the quotes around {odd} become part of the text; YAML's quotes are ' and \"")
    return values


def _emptied(value: object, text: str) -> str:
    """Return the first key without a value, as `name: ""` becomes within double quotes; empty if there is none."""
    if isinstance(value, list):
        return next((name for inner in value if (name := _emptied(inner, text))), "")
    for key, inner in value.items() if isinstance(value, dict) else ():
        if inner is None and re.search(rf"\b{re.escape(str(key))}:\s*(?:[,}}]|\Z)", text):
            return str(key)
        if name := _emptied(inner, text):
            return name
    return ""


def _quoted_in(value: object) -> Iterator[str]:
    """Yield the texts that are within quotation marks of other kinds than YAML's."""
    if isinstance(value, str) and is_quoted(value):
        yield value
    for inner in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from _quoted_in(inner)


def _lists(words: Sequence[str]) -> list[object] | None:
    """Parse words that are one list each, as ROS 1 takes them; None if one is not a list."""
    from graphflow.markup.source import parse_value

    if len(words) < 2 or not all(word.startswith("[") for word in words):
        return None
    with suppress(GraphflowError):
        return [parse_value(word) for word in words]
    return None


def repair(text: str) -> str | None:
    """Return the values that were probably meant, with a brace, space, comma or sign corrected; None if unclear.

    Typographic quotes and dashes are replaced first.
    """
    straight = plain(text)
    straight = straight[1:-1] if is_quoted(text) else straight
    if straight != text and _is_message(straight):
        return straight
    for slip, right in ((re.compile(r"\Z"), ""), *_REPAIRS):
        other = slip.sub(right, text)
        for whole in (other, f"{{{other}}}", f"{other}{'}' * (other.count('{') - other.count('}'))}"):
            if whole != text and _is_message(whole):
                return whole
    return None


def _is_closed(text: str) -> bool:
    """Whether a text is a complete message in braces."""
    return text.startswith("{") and _is_message(text)


def _is_message(text: str) -> bool:
    """Whether a text parses as fields with values."""
    from graphflow.markup.source import parse_value

    with suppress(GraphflowError):
        values = parse_value(text)
        return isinstance(values, dict) and _has_fields(values)
    return False


def _has_fields(value: object) -> bool:
    """Whether all keys of a value, at any depth, could be names of fields."""
    if isinstance(value, dict):
        return all(str(key).isidentifier() and _has_fields(inner) for key, inner in value.items())
    return all(map(_has_fields, value)) if isinstance(value, list) else True


def messages_in(file: Path) -> list[tuple[str, object]]:
    """Read the messages in a file, each with its place: documents of YAML, as `topic echo` prints them.

    Raises:
        UsageFault: The file cannot be read, has no message, or one of its documents is not YAML.
    """
    from graphflow.errors import GraphFileError, UsageFault
    from graphflow.markup.source import read

    try:
        text = found_text(file, bound=_MESSAGES_BOUND)
    except (OSError, UnicodeDecodeError) as error:
        raise UsageFault(f"{file}: {getattr(error, 'strerror', None) or 'is not UTF-8 text'}") from None
    found: list[tuple[str, object]] = []
    line = 0
    for document in _BETWEEN_DOCUMENTS.split(text):
        if _CONTENT.search(document):
            first = line + document[: len(document) - len(document.lstrip())].count("\n") + 1
            try:
                found.append((f"{file}:{first}", read("\n" * line + document, str(file)).data))
            except GraphFileError as error:
                raise UsageFault(str(error)) from None
        line += document.count("\n")
    if not found:
        raise UsageFault(f"{file} has no message; graphflow topic echo TOPIC > {file} writes some")
    return found
