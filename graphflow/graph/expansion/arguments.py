"""The arguments of a graph: declared under `args`, given on the command line or by an including file."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence

from graphflow.errors import GraphFileError, Place
from graphflow.graph.checks.validation import Problems
from graphflow.graph.model import ARG_TYPES, Arg, keys_of
from graphflow.markup import source
from graphflow.markup.source import Data
from graphflow.markup.substitutions import Written
from graphflow.markup.tree import Item
from graphflow.names import did_you_mean

COMMAND_LINE = Place("command line")
_OF_NODES = "a parameter of a node goes below its params:, or is set by graphflow param set NODE {} VALUE"
_SLIP = re.compile(r"([^\W\d]\w*) ?(?::=|[:=]) ?((?!\S*:=)\S+)")
"""An argument with a wrong sign or with spaces: `x=1`, `x:= 1`, `x: 1`."""


class Arguments:
    """The values of a graph's arguments.

    Args:
        given: Arguments from the command line, `name:=value`.
    """

    def __init__(self, given: Sequence[str], problems: Problems) -> None:
        self._problems = problems
        self._given = given_values(given)
        for text in _no_arguments(given):
            slip = _SLIP.fullmatch(text)
            meant = f"; write {slip[1]}:={slip[2]}" if slip else ""
            if slip is not None and slip[1] in self._given:  # as in `x:= 1`, which alone gives no value
                self._given[slip[1]] = slip[2]
            if text.endswith((".yaml", ".yml")):
                meant = "; give one graph file at a time, or a third one with include: [FILE, FILE]"
            problems.add(COMMAND_LINE, f"{text!r}: an argument is written name:=value{meant}")
        self.values: dict[str, Data] = {}
        """Values of the arguments that the command line may set, by name."""

    def of_file(
        self,
        declared: Item | None,
        outer: Mapping[str, Data],
        fixed: Mapping[str, Item],
        substitute: Callable[[Item, Mapping[str, Data]], Item] = lambda item, _: item,
        texts: Mapping[str, str] | None = None,
    ) -> dict[str, Data]:
        """Return the values of a file's arguments.

        Args:
            declared: The file's section `args`.
            outer: The values where the file is included.
            fixed: Values given by the including file.
            substitute: Makes the substitutions in a default, with the values of earlier arguments.
            texts: For a launch file, whose arguments are texts: the defaults as they are written.
        """
        specs = declared.entries if declared is not None else {}
        for name, item in fixed.items():
            if name not in specs:
                help_ = did_you_mean(name, specs) or "; it declares none of that name under args:"
                self._problems.add_unless_ros(item.at, f"the included file has no argument {name!r}{help_}")
        found = {**outer, **{name: item.plain() for name, item in fixed.items() if name not in specs}}
        for name, spec in specs.items():
            if name in fixed:
                given = fixed[name].plain()
                value = given.value if isinstance(given, Written) else given
                found[name] = self._checked(name, value, spec, fixed[name].place)
                if texts is not None:
                    found[name] = given if isinstance(given, Written) else Written(_written(value))
                continue
            if name not in outer:
                if "default" in spec.entries:
                    default = substitute(spec.entries["default"], found)
                    spec = spec.with_value({**spec.entries, "default": default})
                found[name] = self._own(name, spec) if texts is None else self._text(name, spec, texts.get(name, "$("))
            value = found[name]
            self.values[name] = str(value) if isinstance(value, Written) else value
        if texts is not None:  # in ROS, `$(var ...)` also finds arguments that are not declared
            found = {**{name: Written(text) for name, text in self._given.items()}, **found}
        return found

    def refuse_strays(self) -> None:
        """Report arguments on the command line that no file declares."""
        for name in self._given:
            if name not in self.values:
                help_ = did_you_mean(name, self.values)
                if self._problems.launch_files:
                    help_ = help_ or f"; only $(var {name}) has its value"
                    self._problems.remark(COMMAND_LINE, f"no argument {name!r} is declared{help_}")
                else:
                    help_ = help_ or "; the file declares none"
                    way = "" if help_.startswith("; did you mean") else f"; {_OF_NODES.format(name)}"
                    self._problems.add(COMMAND_LINE, f"there is no argument {name!r}{help_}{way}")

    def _text(self, name: str, spec: Item, default: str) -> Written:
        """Return the value of a launch file's argument: any text, if it is among the choices."""
        if name not in self._given:
            value = self._own(name, spec)
            return Written(_written(value) if "$(" in default else default)
        text = Written(self._given[name])
        self._refuse_others(name, text.value, spec)
        return text

    def _own(self, name: str, spec: Item) -> Data:
        settings = spec.entries
        if name in self._given:
            return self._checked(name, _read(self._given[name], settings), spec, COMMAND_LINE)
        if "default" in settings:
            return self._checked(name, settings["default"].plain(), spec, settings["default"].place)
        # Faults of the declaration itself are reported when it is validated.
        if spec.value is None or (isinstance(spec.value, dict) and settings.keys() <= set(keys_of(Arg))):
            self._problems.add(spec.at, f"argument {name!r} has no default: give it as {name}:=VALUE")
        return ""

    def _checked(self, name: str, value: Data, spec: Item, place: Place) -> Data:
        """Check a value against its declared type, or that of its default, and its choices."""
        settings = spec.entries
        wanted = str(settings["type"].value) if "type" in settings else ""
        if wanted in ARG_TYPES:
            types, words = ARG_TYPES[wanted]
            if (isinstance(value, bool) and bool not in types) or not isinstance(value, types):
                self._problems.add(place, f"argument {name!r}: expected {words}, got {value!r}")
            elif isinstance(value, int) and wanted == "float":
                value = float(value)
        elif place == COMMAND_LINE and not _is_alike(value, settings.get("default")):
            default = settings["default"].plain()
            text = f"argument {name!r}: expected {_kind(default)}, as its default {_written(default)} is, got {value!r}"
            self._problems.add(place, text)
        self._refuse_others(name, value, spec)
        return value

    def _refuse_others(self, name: str, value: Data, spec: Item) -> None:
        """Report a value that is not one of the choices."""
        choices = spec.entries["choices"].plain() if "choices" in spec.entries else None
        if isinstance(choices, list) and choices and value not in choices:
            shown = ", ".join(map(str, choices))
            self._problems.add(spec.at, f"argument {name!r} is {value!r}, but must be one of {shown}")


def given_values(words: Sequence[str]) -> dict[str, str]:
    """Return the values of arguments on the command line, `name:=value`, by name."""
    pairs = (word.partition(":=") for word in words)
    return {name: text for name, arrow, text in pairs if arrow and name}


def arguments_after_name(text: str) -> str:
    """Return the fault of arguments after the name of an included file; empty if there are none."""
    name, _, given = text.partition(" ")
    pairs = ", ".join(f"{word}: {value}" for word, value in given_values(given.split()).items())
    return f"arguments stand apart: include: {{file: {name}, args: {{{pairs}}}}}" if pairs else ""


def _no_arguments(words: Sequence[str]) -> Iterator[str]:
    """Yield the words that are no `name:=value`, each joined with those that only a space separates from it."""
    rest = list(words)
    while rest:
        size = next((n for n in (3, 2) if len(rest) >= n and _SLIP.fullmatch(" ".join(rest[:n]))), 1)
        if size > 1 or ":=" not in rest[0] or rest[0].startswith(":="):
            yield " ".join(rest[:size])
        del rest[:size]


def _read(text: str, settings: Mapping[str, Item]) -> Data:
    """Parse an argument of the command line as YAML, unless its type or its default is a text."""
    default = settings["default"].value if "default" in settings else None
    wants_text = "type" in settings and settings["type"].value == "str"
    wants_text = wants_text or ("type" not in settings and isinstance(default, str))
    try:
        value = source.read(text, "command line").data
    except GraphFileError:
        return text
    return text if wants_text and not isinstance(value, str) else value


def _is_alike(value: Data, default: Item | None) -> bool:
    """Return whether a value is of the same kind as the default, if that is a truth value or a number."""
    if default is None or not isinstance(default.value, (bool, int, float)):
        return True
    return _kind(value) == _kind(default.value)


def _kind(value: Data) -> str:
    kinds = {bool: "true or false", int: "a number", float: "a number", list: "a list", dict: "a mapping"}
    return kinds.get(type(value), "text")


def _written(value: Data) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
