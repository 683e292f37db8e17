"""Substitutions and conditions in the blocks of a graph file."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from graphflow.errors import GraphFileError, Place, Problem
from graphflow.graph.checks.validation import Problems
from graphflow.markup.source import Data
from graphflow.markup.substitution_words import foreign_variables
from graphflow.markup.substitutions import Outside, SubstitutionError, Substitutions, Written, truth
from graphflow.markup.tree import Item, located, shared

MAX_MADE = 500_000
"""Values of an expanded graph."""


@dataclass(frozen=True)
class Scope:
    """The context of a block."""

    values: Mapping[str, Data]
    """Values of `$(var ...)`, by name."""
    files: tuple[Path, ...]
    """The file, after those that include it."""
    namespace: str = "/"
    shared: tuple[Mapping[str, Item], ...] = ()
    """The settings of the groups around the block, the innermost first."""
    templates: Mapping[str, Item] = field(default_factory=dict)
    is_top: bool = True
    """Whether settings of the file are those of the graph."""


class Values:
    """The values of a graph's files.

    Args:
        outside: The environment of substitutions.
        files: The graph files, by the names that messages have for them.
    """

    def __init__(self, outside: Outside, files: Mapping[str, Path], problems: Problems) -> None:
        self._outside, self._files, self._problems = outside, files, problems
        self._made = 0

    def is_left_out(self, item: Item, scope: Scope) -> bool:
        """Return whether a block's condition leaves it out."""
        left_out = False
        for key, wanted in (("if", True), ("unless", False)):
            condition = item.entries.get(key)
            if condition is None:
                continue
            try:
                value = self.made(condition.plain(), condition.place, scope, is_text=self._is_launch(condition.place))
                left_out |= truth(value, condition.place.file) is not wanted
            except SubstitutionError as error:
                self._problems.add_unknown(condition.place, f"{key}: {error}")
        return left_out

    def _is_launch(self, place: Place) -> bool:
        return place.file in self._problems.launch_files

    def made(self, value: Data, place: Place, scope: Scope, *, is_word: bool = False, is_text: bool = False) -> Data:
        """Make the substitutions in a text; any other value is returned unchanged.

        Args:
            is_word: Whether it is a word of a command line, which stays a text.
            is_text: Whether it stays a text for another reason.
        """
        if not isinstance(value, str):
            return value
        if not is_word and not self._is_launch(place):
            for written, name in foreign_variables(value, scope.values):
                self._problems.remark(place, f"{written} stays as it is; for the value of {name!r} write $(var {name})")
        if "$(" not in value:
            return value
        file = self._files.get(place.file, Path())
        params = shared("params", scope.shared) if "param" in value else {}
        variables = {name: str(text) for name, text in shared("env", scope.shared).items()}
        outside = self._outside.with_env(variables)
        try:
            made = Substitutions(scope.values, file, outside, params, is_launch=self._is_launch(place))
            return made.apply(value, is_word=is_word or is_text)
        except SubstitutionError as error:
            self._problems.add_unknown(place, str(error))
            return value

    def substituted(
        self,
        item: Item,
        scope: Scope,
        words: Collection[str] = (),
        texts: Collection[str] = (),
        *,
        is_word: bool = False,
        is_text: bool = False,
    ) -> Item:
        """Make every substitution in an item, in keys too.

        Args:
            words: Keys of lists whose items are words of a command line.
            texts: Keys of other values that stay texts.
            is_word: Whether the item itself is such a word.
            is_text: Whether the item itself, or all in it, stays a text.
        """
        if isinstance(item.value, dict):
            result: dict[str, Item] = {}
            for key, inner in item.value.items():
                name = str(self.made(key, inner.at, scope))
                if name in result:
                    self._problems.add(inner.at, f"the key {key!r} becomes {name!r}, which is already here")
                stays = is_text or name in texts
                result[name] = self.substituted(inner, scope, is_word=name in words, is_text=stays)
            return item.with_value(result)
        if isinstance(item.value, list):
            inside = (self.substituted(inner, scope, is_word=is_word, is_text=is_text) for inner in item.value)
            return item.with_value([*inside])
        is_written = isinstance(item.value, Written)
        value = self.made(item.value, item.place, scope, is_word=is_word or is_written, is_text=is_text)
        value = Written(value) if is_written else value
        self._count(value, item.place)
        return located(value, item.place).with_key(item.key)

    def _count(self, value: Data, place: Place) -> None:
        """Count the values that loops and arguments make, which could exceed any memory."""
        todo = [value]
        while todo:
            value = todo.pop()
            self._made += 1
            if self._made > MAX_MADE:
                raise GraphFileError([Problem(place, f"loops and arguments make more than {MAX_MADE:,} values of it")])
            if isinstance(value, (list, dict)):
                todo += value.values() if isinstance(value, dict) else value
