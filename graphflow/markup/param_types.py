"""Conversion of launch-file texts to parameter types; a text without a declared type is read as YAML.

    as_type("float", "10")  ->  10.0        as_type("yaml", "['a1', 'a2']")  ->  ["a1", "a2"]

Source: launch.utilities.type_utils and launch_ros.parameter_descriptions.
"""

from __future__ import annotations

from graphflow.errors import GraphFileError
from graphflow.markup import source
from graphflow.markup.source import Data, Scalar
from graphflow.names import did_you_mean

_LIST = "list_of_"
_WORDS = {"str": "a text", "int": "an integer", "float": "a number", "bool": "true or false"}
TYPES = (*_WORDS, *(f"{_LIST}{name}" for name in _WORDS))
"""The type names of launch files."""
_TRUTH = {"true": True, "1": True, "yes": True, "on": True, "false": False, "0": False, "no": False, "off": False}


def as_type(name: str, value: Data) -> Data:
    """Convert a value to a type: one of `TYPES`, or `yaml` for the YAML value of a text.

    Raises:
        ValueError: There is no such type, or the value cannot be converted.
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


def from_yaml(text: str) -> Data:
    """Parse a text as the YAML value of a parameter; mappings and nulls, which no parameter can have, stay text."""
    try:
        value = source.read(str(text), "value").data
    except GraphFileError:
        return text
    return text if value is None or isinstance(value, dict) else value


def uniform(values: list[Data]) -> list[Data]:
    """Give the values of a list one type, as those of a parameter have: integers among floats become floats.

    Raises:
        ValueError: The types differ.
    """
    kinds = {type(value) for value in values}
    if kinds == {int, float}:
        return [float(value) for value in values if isinstance(value, (int, float))]
    if len(kinds) > 1 or kinds & {list, dict, type(None)}:
        raise ValueError(f"expected values of one type, got {values!r}")
    return values


def _scalar(name: str, value: Data) -> Scalar:
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
