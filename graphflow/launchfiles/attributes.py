"""Attributes of actions in ROS's launch files: their forms, faults, and words."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable

from graphflow.markup.substitution_words import UnclosedError, spans
from graphflow.markup.tree import Item
from graphflow.names import did_you_mean

_LISTS = {"param", "remap", "env", "arg", "choice", "composable_node", "extra_arg", "keep", "let"}
"""Attributes that are lists in YAML, and in XML one element for each item."""
_OUTPUTS = ("screen", "log", "both", "own_log", "full")
"""The destinations that launch has for the output of a program."""


def shape_fault(key: str, value: Item) -> str | None:
    """Return the fault in the form of an attribute: a mapping in place of a list, which launch refuses."""
    if key == "output":
        return output_fault(value.value)
    if key not in _LISTS or not isinstance(value.value, dict):
        return None
    if key == "param" and not value.value.keys() & {"name", "from"}:
        return None  # names and values, which are reported where they are read
    first = next(iter(value.value), "name")
    is_flow = value.key is not None and value.key.line == value.place.line
    return f"{key} is a list: " + ("write [ ] around { }" if is_flow else f"put '- ' before '{first}:'")


def output_fault(output: object) -> str | None:
    """Return the fault of an `output` attribute; None for a valid one, or one for stdout and stderr separately."""
    if not isinstance(output, str) or "$(" in output or output in _OUTPUTS:
        return None
    return f"output: {output!r} is not one of launch's{did_you_mean(output, _OUTPUTS)}"


def children(item: Item) -> list[Item]:
    """Return the actions within an action."""
    found = item.entries.get("children")
    return found.items if found is not None else []


def words(item: Item | None) -> list[str]:
    """Return the words of a text, or of a list of words."""
    if item is None:
        return []
    if isinstance(item.value, list):
        return [str(word.value) for word in item.value]
    try:
        return split(str(item.value))
    except ValueError:  # a quote that is not closed
        return str(item.value).split()


def unescaped(item: Item) -> Item:
    r"""Remove the backslashes with which launch files escape characters; `\$(` stays."""
    if isinstance(item.value, dict):
        return item.with_value({key: unescaped(inner) for key, inner in item.value.items()})
    if isinstance(item.value, list):
        return item.with_value([unescaped(inner) for inner in item.value])
    if not isinstance(item.value, str) or "\\" not in item.value:
        return item
    try:
        parts = list(spans(item.value))
    except UnclosedError:  # reported where the substitution is made
        return item
    # `\$(` without its backslash would be a substitution.
    texts = (f"$({p})" if is_inside else _ESCAPED.sub(r"\1", p).replace("$(", r"\$(") for p, is_inside in parts)
    return item.with_value("".join(texts))


_ESCAPED = re.compile(r"\\(.)", re.DOTALL)
_MARK = re.compile("\ue000(\\d+)\ue001")
"""A placeholder for a substitution, between two private-use characters."""


def split(text: str, words_of: Callable[[str], list[str]] = shlex.split) -> list[str]:
    """Split a text into words, as a shell does, but not at spaces within a substitution, `$(var rate)`.

    Args:
        words_of: Splits a text without substitutions.

    Raises:
        ValueError: A quote is not closed.
    """
    spans: list[str] = []
    # The text itself must not contain what is taken for a placeholder.
    rest, kept = text.replace("\ue000", " "), ""
    while (begin := rest.find("$(")) >= 0 and (end := _end(rest, begin + 2)):
        kept += f"{rest[:begin]}\ue000{len(spans)}\ue001"
        spans.append(rest[begin:end])
        rest = rest[end:]
    return [_MARK.sub(lambda found: spans[int(found[1])], word) for word in words_of(kept + rest)]


def _end(text: str, begin: int) -> int:
    """Return the index after the closing parenthesis of one that is open; 0 if it is not closed."""
    depth = 1
    for place in range(begin, len(text)):
        depth += {"(": 1, ")": -1}.get(text[place], 0)
        if depth == 0:
            return place + 1
    return 0


def has_value(item: Item, key: str, *wanted: str) -> bool:
    """Return whether an attribute has one of some values, in any case."""
    value = item.entries.get(key)
    return value is not None and str(value.value).lower() in wanted
