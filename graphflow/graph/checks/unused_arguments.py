"""Arguments of graph files that no substitution uses, so that setting them has no effect."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping

from graphflow.errors import Place, Problem
from graphflow.markup.substitution_words import UnclosedError, foreign_variables, spans
from graphflow.markup.tree import Item

_NAMES = re.compile(r"\w+")
_COMPUTED = re.compile(r"\bvar\s+[^\s)]*\$\(")
"""An argument whose name is itself the result of a substitution: `$(var $(var side)_speed)`."""
_OTHER_TEXT = re.compile(r"\$\(\s*substituted\b")
"""The substitutions in another file."""


def unused_arguments(files: Mapping[str, Item], followed: Collection[Place]) -> Iterator[Problem]:
    """Yield a remark on each declared argument that no substitution of any of the files names.

    Nothing is reported if a use could be out of sight: in an included file that a condition leaves out, in a name that
    a substitution makes, or in another file with substitutions.

    Args:
        files: The graph files, none of which may be a launch file, by name.
        followed: Places of the includes whose files are among these.
    """
    if any(place not in followed for top in files.values() for place in _includes(top)):
        return
    texts = [text for top in files.values() for text in _texts(top)]
    made = [text for text in texts if "$(" in text]
    if any(_COMPUTED.search(text) or _OTHER_TEXT.search(text) for text in made):
        return
    used = {name for text in made for name in _used(text)}
    for top in files.values():
        args = top.entries.get("args", top).entries if "args" in top.entries else {}
        # Variables as shells write them have a remark of their own.
        foreign = {name for text in texts for _, name in foreign_variables(text, args)}
        for name, spec in args.items():
            if name not in used | foreign:
                text = f"nothing uses the argument {name!r}; write $(var {name}) where it is meant"
                yield Problem(spec.at, text)


def _includes(block: Item) -> Iterator[Place]:
    """Yield the places of the includes in a file, group or loop."""
    for key in ("include", "group", "for"):
        item = block.entries.get(key)
        for one in () if item is None or item.value is None else item.items or [item]:
            if key == "include":
                yield one.place
            else:
                yield from _includes(one)


def _texts(item: Item) -> Iterator[str]:
    """Yield all texts in an item, keys too."""
    inner: Iterable[Item] = item.items
    if isinstance(item.value, dict):
        yield from item.value
        inner = item.value.values()
    elif isinstance(item.value, str):
        yield item.value
    for one in inner:
        yield from _texts(one)


def _used(text: str) -> Iterator[str]:
    """Yield the words within the substitutions of a text."""
    try:
        inside = [part for part, is_inside in spans(text) if is_inside]
    except UnclosedError:  # which has been reported
        inside = [text]
    for part in inside:
        yield from _NAMES.findall(part)
