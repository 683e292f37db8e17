"""Attributes of actions in ROS's launch files, as readers of them need them."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable

from graphflow.markup.substitution_words import UnclosedError, spans
from graphflow.markup.tree import Item
from graphflow.names import did_you_mean

_LISTS = {"param", "remap", "env", "arg", "choice", "composable_node", "extra_arg", "keep", "let"}
"""Attributes that are lists in YAML, of which XML has an element for each of their items."""
_OUTPUTS = ("screen", "log", "both", "own_log", "full")
"""Where launch lets the output of a program go."""


def shape_fault(key: str, value: Item) -> str | None:
    """What is wrong with the form of an attribute; launch refuses a mapping in the place of a list."""
    if key == "output":
        return output_fault(value.value)
    if key not in _LISTS or not isinstance(value.value, dict):
        return None
    if key == "param" and not value.value.keys() & {"name", "from"}:
        return None  # values by their names, which is told where they are read
    first = next(iter(value.value), "name")
    is_flow = value.key is not None and value.key.line == value.place.line
    return f"{key} is a list: " + ("write [ ] around { }" if is_flow else f"put '- ' before '{first}:'")


def output_fault(output: object) -> str | None:
    """What is wrong with where the output of a program is to go, be it told apart for stdout and stderr."""
    if not isinstance(output, str) or "$(" in output or output in _OUTPUTS:
        return None
    return f"output: {output!r} is none of launch's{did_you_mean(output, _OUTPUTS)}"


def children(item: Item) -> list[Item]:
    """The actions within an action."""
    found = item.entries.get("children")
    return found.value if found is not None and isinstance(found.value, list) else []


def items(item: Item | None) -> list[Item]:
    """A list's items, of which one alone may stand without the list."""
    if item is None:
        return []
    return item.value if isinstance(item.value, list) else [item]


def words(item: Item | None) -> list[str]:
    """The words of a text, or of a list of them."""
    if item is None:
        return []
    if isinstance(item.value, list):
        return [str(word.value) for word in item.value]
    try:
        return split(str(item.value))
    except ValueError:  # a quote that is not closed
        return str(item.value).split()


def unescaped(item: Item) -> Item:
    r"""The same without the backslashes by which launch files take the meaning from a character; `\$(` stays."""
    if isinstance(item.value, dict):
        return item._replace(value={key: unescaped(inner) for key, inner in item.value.items()})
    if isinstance(item.value, list):
        return item._replace(value=[unescaped(inner) for inner in item.value])
    if not isinstance(item.value, str) or "\\" not in item.value:
        return item
    try:
        parts = list(spans(item.value))
    except UnclosedError:  # which is reported where the substitution is made
        return item
    texts = (f"$({p})" if is_inside else _ESCAPED.sub(r"\1", p).replace("$(", r"\$(") for p, is_inside in parts)
    return item._replace(value="".join(texts))


_ESCAPED = re.compile(r"\\(.)", re.DOTALL)
_MARK = re.compile("\ue000(\\d+)\ue001")
"""What stands for a substitution, in two characters that no text has."""


def split(text: str, words_of: Callable[[str], list[str]] = shlex.split) -> list[str]:
    """The words of a text, as a shell has them; spaces in a substitution, `$(var rate)`, do not part it.

    Args:
        words_of: Finds words where there are no substitutions.

    Raises:
        ValueError: A quote is not closed.
    """
    spans: list[str] = []
    rest, kept = text.replace("\ue000", " "), ""
    while (begin := rest.find("$(")) >= 0 and (end := _end(rest, begin + 2)):
        kept += f"{rest[:begin]}\ue000{len(spans)}\ue001"
        spans.append(rest[begin:end])
        rest = rest[end:]
    return [_MARK.sub(lambda found: spans[int(found[1])], word) for word in words_of(kept + rest)]


def _end(text: str, begin: int) -> int:
    """Where the parenthesis ends that is open at a place; 0 if it does not."""
    depth = 1
    for place in range(begin, len(text)):
        depth += {"(": 1, ")": -1}.get(text[place], 0)
        if depth == 0:
            return place + 1
    return 0


def says(item: Item, key: str, *wanted: str) -> bool:
    """Whether an attribute is there and one of some words, in any case."""
    value = item.entries.get(key)
    return value is not None and str(value.value).lower() in wanted
