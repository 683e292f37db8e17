"""Conversion of settings in launch files: those of a node, and those for all later actions."""

from __future__ import annotations

import json
import re
from pathlib import Path

from graphflow.launchfiles.attributes import has_value
from graphflow.launchfiles.attributes import words as words_of
from graphflow.launchfiles.commands import typed
from graphflow.markup import ros1_words
from graphflow.markup.param_types import as_type
from graphflow.markup.source import Complain
from graphflow.markup.substitution_words import as_word
from graphflow.markup.substitutions import Written
from graphflow.markup.tree import Item, items, located
from graphflow.names import did_you_mean
from graphflow.reading import found_text

_OPTIONS = {"-r": "remap", "--remap": "remap", "-p": "params", "--param": "params"}
"""The keys of a graph file by ROS 2's command-line options."""
_OF_PARAMS = ("name", "value", "type", "param", "from", "allow_substs")
_VARIABLE = re.compile(r"\$\(var [\w.]+\)\Z")
"""A text that is only the value of an argument."""


def setting(name: str, item: Item, complain: Complain) -> tuple[str, Item]:
    """Convert an action that sets something for later actions to the key of a group and its value."""
    match name:
        case "push_ros_namespace":
            return "namespace", conditional(item, item.entries.get("namespace", Item("", item.place)), "")
        case "set_parameter":
            named = pair(item, "name", "value", complain)
            kind = str(item.entries["type"].value) if "type" in item.entries else "yaml"
            values = {key: parameter(value, kind, complain) for key, value in named.entries.items()}
            return "params", named.with_value(values)
        case "set_parameters_from_file":
            file = item.entries.get("filename")
            if file is None or not file.value:
                complain(item.at, "set_parameters_from_file: the attribute 'filename' is missing")
                return "params_file", Item([], item.place)
            return "params_file", Item([file], file.place)
        case "set_use_sim_time":
            value = typed(item.entries.get("value", Item("", item.place)))
            return "params", Item({"use_sim_time": value}, item.place)
        case "set_remap":
            return "remap", pair(item, "from", "to", complain)
        case "append_env":
            named, get = pair(item, "name", "value", complain), item.entries.get
            separator = str(get("separator", Item(":", item.place)).value)
            is_first = has_value(item, "prepend", "true", "1", "yes")
            found: dict[str, Item] = {}
            for name, value in named.entries.items():
                # The separator follows a former value alone.
                old, new = f"$(optenv {name})", str(value.value)
                between = f"$(if $(not-equals '{old}' '') {as_word(separator)} '')"
                found[name] = value.with_value(f"{new}{between}{old}" if is_first else f"{old}{between}{new}")
            return "env", named.with_value(found)
        case _:
            return "env", pair(item, "name", "value", complain)


def conditional(item: Item, value: Item, otherwise: str) -> Item:
    """Convert a value under a condition to a substitution that is `otherwise` if the condition does not hold."""
    for key in ("if", "unless"):
        if key in item.entries:
            ways = [str(value.value), otherwise]
            chosen = " ".join(map(as_word, [str(item.entries[key].value), *(ways if key == "if" else ways[::-1])]))
            value = value.with_value(f"$(if {chosen})")
    return value


def conditions(*items: Item) -> dict[str, Item]:
    """Return the condition under which several conditions hold, such as those of an action and of its group."""
    given = [(key, item.entries[key]) for item in items for key in ("if", "unless") if key in item.entries]
    if len(given) < 2:
        return dict(given)
    words = [as_word(_written(value)) for _, value in given]
    words = [word if key == "if" else f"$(not {word})" for (key, _), word in zip(given, words, strict=True)]
    return {"if": given[0][1].with_value(f"$(all {' '.join(words)})")}


def pair(item: Item, key: str, value: str, complain: Complain, *, is_written: bool = False) -> Item:
    """Return a mapping with one entry: the key and the value are attributes of an action.

    Args:
        is_written: Whether the value is that of a launch configuration.
    """
    name = item.entries.get(key)
    if name is None or not isinstance(name.value, str):
        way = f"one is written {key}: ..., {value}: ..."
        old, arrow, new = str(item.value).partition(":=")
        if isinstance(item.value, str) and arrow:
            way = f"write {{{key}: {old}, {value}: {new}}}"
        if len(item.entries) == 1 and value not in item.entries:
            [(written, meant)] = item.entries.items()
            way = f"write {{{key}: {written}, {value}: {meant.plain()}}}"
        complain(item.at, f"the attribute {key!r} is missing; {way}")
        return Item({}, item.place)
    found = item.entries.get(value, Item("", item.place))
    # With a value, an unknown attribute is reported elsewhere; without, it was probably meant as the value.
    others = () if value in item.entries else sorted(item.entries.keys() - {key, "if", "unless", "type", "default"})
    for strange in others:
        complain(item.entries[strange].at, f"unknown attribute {strange!r}{did_you_mean(strange, (value,))}")
    if others:
        return Item({}, item.place)
    return Item({name.value: (as_text(found) if is_written else found).with_key(name.place)}, item.place)


def as_text(item: Item) -> Item:
    """Convert the value of a launch configuration to a text, which is parsed where a value is needed."""
    return item.with_value(Written(_written(item)))


def _written(item: Item) -> str:
    return str(item.value).lower() if isinstance(item.value, bool) else str(item.value)


def params(item: Item, entries: dict[str, Item], complain: Complain, note: Complain) -> None:
    """Convert the `param` attribute to the entries `params` and `params_file`."""
    files: list[Item] = []
    given = items(item.entries.get("param"))
    values = _params(given, files, complain)
    _note_order(given, note)
    if files:
        entries["params_file"] = Item(files, files[0].place, files[0].place)
    if values:
        place = item.entries["param"].place
        entries["params"] = Item(values, place, place)


def _params(params: list[Item], files: list[Item], complain: Complain) -> dict[str, Item]:
    """Return the values of a list of parameters; the parameter files in it are added to `files`."""
    values: dict[str, Item] = {}
    for param in params:
        if isinstance(param.value, dict) and not param.entries.keys() & {*_OF_PARAMS}:
            first, given = next(iter(param.entries.items()), ("rate", Item(1.0, param.place)))
            value = json.dumps(given.plain(), default=str)
            way = f"expected a list of names and values, such as - {{name: {first}, value: {value}}}"
            if param.place.file.endswith((".xml", ".launch")):
                way = f'write <param name="{first}" value="{given.plain()}"/>'
            complain(param.place, f"param: {way}")
            continue
        _refuse_unknown(param, complain)
        if not param.entries.keys() & {"from", "param", "value"} and param.entries.keys() - {*_OF_PARAMS}:
            continue  # its unknown attribute is reported, and was probably meant as the value
        name = param.entries.get("name")
        if "from" in param.entries:
            files.append(_params_file(param))
        elif "param" in param.entries and name is not None:
            inner = _params(items(param.entries["param"]), files, complain)
            values[str(name.value)] = Item(inner, param.place, name.place)
        else:
            named = pair(param, "name", "value", complain)
            kind = str(param.entries["type"].value) if "type" in param.entries else ""
            values.update({key: parameter(value, kind, complain) for key, value in named.entries.items()})
    return values


def _note_order(given: list[Item], note: Complain) -> None:
    """Note the values that a parameter file behind them sets as well: in ROS 2 the last one wins."""
    before: set[str] = set()
    for param in given:
        if "from" not in param.entries:
            before |= {str(param.entries["name"].value)} if "name" in param.entries else set()
            continue
        file = Path(str(param.entries["from"].value))
        text = _shared_text(file) if before else ""
        for name in sorted(before & set(re.findall(r"^\s*[\"']?([\w./]+)[\"']?\s*:", text, re.MULTILINE))):
            way = "put the file first, or leave the value out"
            note(param.place, f"param: {name} has a value before {file.name}, which wins here, and not in ROS 2: {way}")


def _shared_text(file: Path) -> str:
    """Return the text of a parameter file, if it is for all nodes; else it may be for others."""
    try:
        text = found_text(file, "replace") if file.is_absolute() and file.is_file() else ""
    except OSError:  # such as a name that is too long
        return ""
    is_for_all = re.search(r"^[\"']?/\*\*[\"']?\s*:", text, re.MULTILINE) and text.count("ros__parameters") == 1
    return text if is_for_all else ""


def _refuse_unknown(param: Item, complain: Complain) -> None:
    for key, value in param.entries.items():
        if key not in _OF_PARAMS:
            former = ros1_words.attribute("param", key)
            hint = f"; {former}" if former else did_you_mean(key, _OF_PARAMS)
            hint = "; write value" if key == "default" else hint
            complain(value.at, f"param: unknown attribute {key!r}{hint}")


def _params_file(param: Item) -> Item:
    file = param.entries["from"]
    if has_value(param, "allow_substs", "true", "1"):
        return file.with_value(f"$(substituted {as_word(str(file.value))})")
    return file


def parameter(item: Item, kind: str, complain: Complain) -> Item:
    """Convert the value of a parameter; one with substitutions gets its type once they are made.

    Args:
        kind: Its type; `yaml` to parse the text, or empty to keep the type of the value.
    """
    if isinstance(item.value, list):
        inner = kind.removeprefix("list_of_")
        item = item.with_value([parameter(one, inner, complain) for one in item.value])
        if any(isinstance(one.value, str) and "$(" in one.value for one in item.items):
            return item
        kind = kind or "yaml"
    value = item.plain()
    if isinstance(value, str) and "$(" in value:
        # Everything else is a text that substitutions are part of, as in launch, and is parsed when they are made.
        if _VARIABLE.match(value) and kind in ("", "yaml"):  # `$(var x)` alone keeps the type of x
            return item
        return item.with_value(f"$(as {kind or 'yaml'} {as_word(value)})")
    try:
        return located(as_type(kind, value), item.place).with_key(item.key) if kind else item
    except ValueError as error:
        complain(item.place, f"param: {error}")
        return item


def ros_arguments(item: Item, entries: dict[str, Item], note: Complain) -> None:
    """Convert ROS arguments in `args` and `ros_args`: remaps, parameters, and the log level."""
    for key in ("args", "ros_args"):
        given = item.entries.get(key)
        if given is None:
            continue
        words = [word for word in words_of(given) if word not in ("--ros-args", "--")]
        for option, value in zip(words[::2], [*words[1::2], ""][: len(words[::2])], strict=True):
            _option(option, value, Item(value, given.place, given.key), key, entries, note)


def _option(option: str, value: str, at: Item, key: str, entries: dict[str, Item], note: Complain) -> None:
    name, arrow, text = value.partition(":=")
    section = _OPTIONS.get(option)
    if option == "--log-level" and value and not arrow:
        entries["log_level"] = at.with_value(value.lower())
    elif section is not None and name and arrow and not name.startswith("__"):
        before = entries.get(section, Item({}, at.place, at.key))
        setting = typed(at.with_value(text)) if section == "params" else at.with_value(text)
        entries[section] = before.with_value({**before.entries, name: setting})
    else:
        note(at.key or at.place, f"{key}: the node here does not know {option}; it is left out")
