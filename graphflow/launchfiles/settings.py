"""What is set in launch files of ROS's, as the settings of a graph file: of single nodes, or of all that follow."""

from __future__ import annotations

import re

from graphflow.launchfiles.attributes import items, says
from graphflow.launchfiles.attributes import words as words_of
from graphflow.launchfiles.commands import Complain, typed
from graphflow.markup import ros1_words
from graphflow.markup.param_types import as_type
from graphflow.markup.substitution_words import as_word
from graphflow.markup.substitutions import Written
from graphflow.markup.tree import Item, located
from graphflow.names import did_you_mean

_OPTIONS = {"-r": "remap", "--remap": "remap", "-p": "params", "--param": "params"}
"""The keys of a graph file for ROS 2's options."""
_OF_PARAMS = ("name", "value", "type", "param", "from", "allow_substs")
_VARIABLE = re.compile(r"\$\(var [\w.]+\)\Z")
"""An argument alone."""


def setting(name: str, item: Item, complain: Complain) -> tuple[str, Item]:
    """What an action sets for all after it: the key of a group, and its value."""
    match name:
        case "push_ros_namespace":
            return "namespace", conditional(item, item.entries.get("namespace", Item("", item.place)), "")
        case "set_parameter":
            named = pair(item, "name", "value", complain)
            kind = str(item.entries["type"].value) if "type" in item.entries else "yaml"
            values = {key: parameter(value, kind, complain) for key, value in named.entries.items()}
            return "params", named._replace(value=values)
        case "set_use_sim_time":
            value = typed(item.entries.get("value", Item("", item.place)))
            return "params", Item({"use_sim_time": value}, item.place)
        case "set_remap":
            return "remap", pair(item, "from", "to", complain)
        case "append_env":
            named, get = pair(item, "name", "value", complain), item.entries.get
            separator = str(get("separator", Item(":", item.place)).value)
            is_first = says(item, "prepend", "true", "1")
            found = {}
            for name, value in named.entries.items():
                parts = [f"$(optenv {name})", str(value.value)]
                found[name] = value._replace(value=separator.join(parts[::-1] if is_first else parts))
            return "env", named._replace(value=found)
        case _:
            return "env", pair(item, "name", "value", complain)


def conditional(item: Item, value: Item, otherwise: str) -> Item:
    """A value that is set under a condition, as a substitution that gives `otherwise` where that is not met."""
    for key in ("if", "unless"):
        if key in item.entries:
            ways = [str(value.value), otherwise]
            chosen = " ".join(map(as_word, [str(item.entries[key].value), *(ways if key == "if" else ways[::-1])]))
            value = value._replace(value=f"$(if {chosen})")
    return value


def conditions(*items: Item) -> dict[str, Item]:
    """The condition under which all of some actions are carried out, such as one and the group that it is in."""
    given = [(key, item.entries[key]) for item in items for key in ("if", "unless") if key in item.entries]
    if len(given) < 2:
        return dict(given)
    words = [as_word(as_text(value).value) for _, value in given]
    words = [word if key == "if" else f"$(not {word})" for (key, _), word in zip(given, words, strict=True)]
    return {"if": given[0][1]._replace(value=f"$(all {' '.join(words)})")}


def pair(item: Item, key: str, value: str, complain: Complain, *, is_written: bool = False) -> Item:
    """A mapping of what one attribute of an action names to what another says.

    Args:
        is_written: Whether that is the value of a launch configuration.
    """
    name = item.entries.get(key)
    if name is None or not isinstance(name.value, str):
        complain(item.at, f"the attribute {key!r} is missing; one is written {key}: ..., {value}: ...")
        return Item({}, item.place)
    found = item.entries.get(value, Item("", item.place))
    others = () if value in item.entries else sorted(item.entries.keys() - {key, "if", "unless", "type", "default"})
    for strange in others:
        complain(item.entries[strange].at, f"unknown attribute {strange!r}{did_you_mean(strange, (value,))}")
    if others:
        return Item({}, item.place)
    return Item({name.value: (as_text(found) if is_written else found)._replace(key=name.place)}, item.place)


def as_text(item: Item) -> Item:
    """The value of a launch configuration: it is a text, which is read where a value is wanted."""
    text = str(item.value).lower() if isinstance(item.value, bool) else str(item.value)
    return item._replace(value=Written(text))


def params(item: Item, entries: dict[str, Item], complain: Complain) -> None:
    """What `param` says: of values, and of files of them."""
    files: list[Item] = []
    values: dict[str, Item] = {}

    def take(params: list[Item], into: dict[str, Item]) -> None:
        for param in params:
            if isinstance(param.value, dict) and not param.entries.keys() & {*_OF_PARAMS}:
                first = next(iter(param.entries), "rate")
                complain(
                    param.place, f"param: expected a list of names and values, such as - {{name: {first}, value: 1}}"
                )
                continue
            for key, value in param.entries.items():
                if key not in _OF_PARAMS:
                    former = ros1_words.attribute("param", key)
                    hint = f"; {former}" if former else did_you_mean(key, _OF_PARAMS)
                    complain(value.at, f"param: unknown attribute {key!r}{hint}")
            if not param.entries.keys() & {"from", "param", "value"} and param.entries.keys() - {*_OF_PARAMS}:
                continue
            if "from" in param.entries:
                file = param.entries["from"]
                is_substituted = says(param, "allow_substs", "true", "1")
                files.append(
                    file._replace(value=f"$(substituted {as_word(str(file.value))})") if is_substituted else file
                )
            elif "param" in param.entries and isinstance(name := param.entries.get("name"), Item):
                inner: dict[str, Item] = {}
                take(items(param.entries["param"]), inner)
                into[str(name.value)] = Item(inner, param.place, name.place)
            else:
                named = pair(param, "name", "value", complain)
                kind = str(param.entries["type"].value) if "type" in param.entries else ""
                into.update({key: parameter(value, kind, complain) for key, value in named.entries.items()})

    take(items(item.entries.get("param")), values)
    if files:
        entries["params_file"] = Item(files, files[0].place, files[0].place)
    if values:
        place = item.entries["param"].place
        entries["params"] = Item(values, place, place)


def parameter(item: Item, kind: str, complain: Complain) -> Item:
    """The value of a parameter; one with substitutions has its type as soon as they have been made.

    Args:
        kind: Its type, `yaml` for what the text reads as, or nothing for its own.
    """
    value = item.value
    if isinstance(value, list):
        inner = kind.removeprefix("list_of_")
        item = item._replace(value=[parameter(one, inner, complain) for one in value])
        if any(isinstance(one.value, str) and "$(" in one.value for one in item.value):
            return item
        value, kind = item.plain(), kind or "yaml"
    if isinstance(value, str) and "$(" in value:
        if _VARIABLE.match(value) and kind in ("", "yaml"):  # which has the type of what it reads as
            return item
        return item._replace(value=f"$(as {kind or 'yaml'} {as_word(value)})")
    try:
        return located(as_type(kind, value), item.place)._replace(key=item.key) if kind else item
    except ValueError as error:
        complain(item.place, f"param: {error}")
        return item


def ros_words(item: Item, entries: dict[str, Item], note: Complain) -> None:
    """What `args` and `ros_args` say in ROS 2's words: remaps, parameters, and the level of the log."""
    for key in ("args", "ros_args"):
        given = item.entries.get(key)
        if given is None:
            continue
        words = [word for word in words_of(given) if word not in ("--ros-args", "--")]
        for option, value in zip(words[::2], [*words[1::2], ""][: len(words[::2])], strict=True):
            _option(option, value, Item(value, given.place, given.key), key, entries, note)


def _option(option: str, value: str, at: Item, key: str, entries: dict[str, Item], note: Complain) -> None:
    name, arrow, said = value.partition(":=")
    section = _OPTIONS.get(option)
    if option == "--log-level" and value and not arrow:
        entries["log_level"] = at._replace(value=value.lower())
    elif section is not None and name and arrow and not name.startswith("__"):
        before = entries.get(section, Item({}, at.place, at.key))
        made = typed(at._replace(value=said)) if section == "params" else at._replace(value=said)
        entries[section] = before._replace(value={**before.entries, name: made})
    else:
        note(at.key or at.place, f"{key}: the node here does not know {option}; it is left out")
