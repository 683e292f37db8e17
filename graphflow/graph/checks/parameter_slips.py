"""Corrections of parameters in graph files: texts meant as other values, and keys of nodes below `params:`."""

from __future__ import annotations

import linecache
import re
from collections.abc import Collection, Container

from graphflow.errors import GraphflowError, Place
from graphflow.graph.model import NodeSpec, keys_of
from graphflow.graph.plan import Setting
from graphflow.interface import Parameter
from graphflow.markup import source, yaml_slips
from graphflow.markup.expressions import ExpressionError, evaluate
from graphflow.markup.source import Complain
from graphflow.markup.substitution_words import as_argument
from graphflow.markup.tree import Item
from graphflow.names import nearest

_ARITHMETIC = re.compile(r"[-+*/%().\w\s]*[\w)]\s*[-+*/%]\s*[-+*/%().\w\s]*\w[-+*/%().\w\s]*")
"""A text of numbers and names with an operator between two of them."""
_WRITTEN = re.compile(r"""(?P<quote>['"]?)(?P<text>(?:\$\(var \w+\)|[-+*/%.\w ()])+)(?P=quote)""")
_FOREIGN = re.compile(r"\$\{(\w+)\}|\$(\w+)")
"""A variable as shells write it."""
_VALUE = re.compile(r"\$\(var (\w+)\)")


def value_correction(declared: Parameter, setting: Setting) -> str:
    """Return the correction of a text, as a list, an expression, or without quotes."""
    value = setting.value
    if not isinstance(value, str):
        return ""
    if found := _FOREIGN.fullmatch(value):
        return f"write {declared.name}: $(var {found[1] or found[2]})"
    if declared.type.startswith("list[") and (way := yaml_slips.as_list(value)):
        return way
    if declared.unit and (number := value.removesuffix(declared.unit).strip()) != value and _fits(declared, number):
        return f"write {declared.name}: {number}, without the unit"
    if (result := _result(declared, value)) is not None:
        return f"write {declared.name}: {_expression(setting, result)}"
    if not _line_at(setting).startswith((f"'{value}'", f'"{value}"')):
        return ""  # the quotes are not in the file: the text comes from a substitution
    if not _fits(declared, value):
        return ""
    return f"leave out the quotes: {declared.name}: {value.strip()}"


def remark_on_texts(params: Item | None, args: Container[str], remark: Complain) -> None:
    """Remark on each parameter whose value is its own name, which is also that of an argument.

    Args:
        params: The parameters as they are written, without their substitutions.
    """
    for name, value in params.entries.items() if params is not None else ():
        if value.value == name and name in args:
            way = as_argument(name, value.place.file)
            remark(value.place, f"{name!r} is a text here; for the argument of that name write {way}")


def _fits(declared: Parameter, text: str) -> bool:
    """Return whether a text would be a value of the parameter if it were written without quotes."""
    try:
        declared.fit(source.parse_value(text))
    except GraphflowError:
        return False
    return True


def _result(declared: Parameter, text: str) -> object:
    """Return the value of a text that is an expression, if the parameter could have it; else None."""
    if not _ARITHMETIC.fullmatch(text):
        return None
    try:
        return declared.fit(evaluate(text, {}))
    except (ExpressionError, GraphflowError):
        return None


def _expression(setting: Setting, result: object) -> str:
    """Return the expression as a substitution, or its result where none is made: in launch and parameter files."""
    file = setting.place.file
    linecache.checkcache(file)
    is_launch = not file.endswith((".yaml", ".yml")) or ".launch." in file
    if is_launch or any("ros__parameters:" in line for line in linecache.getlines(file)):
        return str(result)
    return f"$(eval {_as_written(setting)})"


def _as_written(setting: Setting) -> str:
    """Return the expression with the names of arguments, if the file has them there, else with their values."""
    found = _WRITTEN.match(_line_at(setting))
    if found is None or not _VALUE.search(found["text"]):
        return str(setting.value).strip()
    return _VALUE.sub(lambda value: value[1], found["text"]).strip()


def _line_at(setting: Setting) -> str:
    """Return the rest of the line at the place of a setting."""
    place = setting.place
    linecache.checkcache(place.file)
    return linecache.getline(place.file, place.line)[place.column - 1 :]


def misplaced_key(name: str, known: Collection[str]) -> tuple[str, str]:
    """Return the key of nodes or of parameter files that an unknown parameter is, and the correction; both may be "".

    Args:
        name: Such as `remap.chatter`, for `remap:` below `params:`.
        known: The parameters of the node.
    """
    key = name.partition(".")[0]
    if key == "ros__parameters":
        return key, "; ros__parameters: is for parameter files: write the parameters directly below params:"
    if key not in keys_of(NodeSpec) or nearest(name, known, cutoff=0.8) is not None:
        return "", ""
    return key, f"; {key} is a key of the node: indent it as params: is"


def set_in_a_method(name: str, cls: Place) -> str:
    """Return the line that sets a parameter on `self`, where none is declared, as the end of a message; else "".

    Args:
        cls: The place of the class.
    """
    pattern = re.compile(rf"\s*self\.{re.escape(name)}\s*=\s*Param\(")
    at = next((number for number, line in enumerate(linecache.getlines(cls.file), 1) if pattern.match(line)), None)
    return (
        "" if at is None else f"; write {name} = Param(...) in the body of the class, and not in {Place(cls.file, at)}"
    )
