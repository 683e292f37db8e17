"""The types of parameters in launch files: texts read as what is asked for, or as YAML where nothing is.

    as_type("float", "10")  ->  10.0        as_type("yaml", "['a1', 'a2']")  ->  ["a1", "a2"]

Source: launch.utilities.type_utils and launch_ros.parameter_descriptions.
"""

from __future__ import annotations

from typing import Any

from graphflow.errors import GraphFileError
from graphflow.markup import source
from graphflow.names import did_you_mean

_LIST = "list_of_"
_WORDS = {"str": "a text", "int": "an integer", "float": "a number", "bool": "true or false"}
TYPES = (*_WORDS, *(f"{_LIST}{name}" for name in _WORDS))
"""The names that launch files have for types."""
_TRUTH = {"true": True, "1": True, "yes": True, "on": True, "false": False, "0": False, "no": False, "off": False}


def as_type(name: str, value: Any) -> Any:
    """A value, such as a text, as one of a type: one of `TYPES`, or `yaml` for what a text reads as.

    Raises:
        ValueError: There is no such type, or the value is of another.
    """
    if name == "yaml":
        found = from_yaml(value) if isinstance(value, str) else value
        return uniform(found) if isinstance(found, list) else found
    if name not in TYPES:
        raise ValueError(f"there is no type {name!r}{did_you_mean(name, TYPES)}")
    if not name.startswith(_LIST):
        return _scalar(name, value)
    values = from_yaml(value) if isinstance(value, str) else value
    if not isinstance(values, list):
        raise ValueError(f"expected a list such as [1, 2], got {value!r}")
    return [_scalar(name.removeprefix(_LIST), inner) for inner in values]


def from_yaml(text: str) -> Any:
    """The YAML value of a text, where a parameter can have it: a mapping stays a text, and so does nothing."""
    try:
        value = source.read(str(text), "value").data
    except GraphFileError:
        return text
    return text if value is None or isinstance(value, dict) else value


def uniform(values: list[Any]) -> list[Any]:
    """A list whose values have one type, as those of a parameter: integers among floats become floats.

    Raises:
        ValueError: They have several.
    """
    kinds = {type(value) for value in values}
    if kinds == {int, float}:
        return [float(value) for value in values]
    if len(kinds) > 1 or kinds & {list, dict, type(None)}:
        raise ValueError(f"expected values of one type, got {values!r}")
    return values


def _scalar(name: str, value: Any) -> Any:
    text = str(value).lower() if isinstance(value, bool) else str(value)
    if name == "str":
        return text
    found = _TRUTH.get(text.strip().lower()) if name == "bool" else _number(name, text)
    if found is None:
        raise ValueError(f"expected {_WORDS[name]}, got {value!r}")
    return found


def _number(name: str, text: str) -> float | None:
    try:
        return int(text) if name == "int" else float(text)
    except ValueError:
        return None
