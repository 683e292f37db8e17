"""Hints for arguments that users of other tools pass to nodes and to `graphflow.run`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from graphflow.errors import InvalidName, UsageFault
from graphflow.names import Remap
from graphflow.runtime.call_site import here

_SYNONYMS = {
    **dict.fromkeys(("ns", "node_namespace"), "namespace"),
    **dict.fromkeys(("remaps", "remappings", "remapping"), "remap"),
    **dict.fromkeys(("params", "parameters", "parameter_overrides"), ""),
    **dict.fromkeys(("node_name",), "name"),
}
"""Other names for a node's arguments; the empty text for arguments whose name is the same."""


def rules_of(remap: object) -> list[Remap]:
    """Parse a node's argument `remap`.

    Raises:
        InvalidName: A rule is invalid, or `remap` is not a list of rules; the text has the correct form.
    """
    if isinstance(remap, str):
        raise InvalidName(f"{here()}: remap= takes a list: remap=[{_quoted(remap)}]")
    if isinstance(remap, Mapping):
        raise InvalidName(f"{here()}: remap= takes a list: {_as_rules(remap)}")
    found = []
    for rule in remap if isinstance(remap, Iterable) else ():
        if isinstance(rule, tuple) and len(rule) == 2:
            raise InvalidName(f"{here()}: a rule is a string: {_as_rules(dict([rule]))}")
        found.append(rule if isinstance(rule, Remap) else Remap.parse(rule))
    return found


def instead_of(keyword: str, value: object) -> str:
    """Return what to write in place of a keyword that a node does not have; "" if unknown."""
    canonical = _SYNONYMS.get(keyword)
    if canonical is None:
        return ""
    written = _argument(keyword, value)
    return f"write {written}" if canonical else f"pass parameters by name: {written}"


def refuse_keywords(given: Mapping[str, object], nodes: Iterable[object]) -> None:
    """Refuse keywords of `graphflow.run` that belong to a node.

    Raises:
        UsageFault: There is a keyword.
    """
    if given:
        first = next(iter(nodes), None)
        name = "Talker" if first is None else first.__name__ if isinstance(first, type) else type(first).__name__
        arguments = ", ".join(_argument(keyword, value) for keyword, value in given.items())
        way = f"{next(iter(given))}= belongs to the node: graphflow.run({name}({arguments}))"
        raise UsageFault(f"{here()}: {way}, or on the command line --ros-args -r __ns:=/NS -r FROM:=TO -p NAME:=VALUE")


def _argument(keyword: str, value: object) -> str:
    """Return an argument of a node as it is written in code."""
    canonical = _SYNONYMS.get(keyword, keyword)
    if canonical == "remap":
        return _as_rules(value)
    if canonical:
        return f"{canonical}={_quoted(value)}"
    values = value if isinstance(value, Mapping) and value else {"gain": 5.0}
    return ", ".join(f"{name}={_quoted(each)}" for name, each in values.items())


def _as_rules(value: object) -> str:
    pairs: Any = value.items() if isinstance(value, Mapping) else value
    if isinstance(pairs, str):
        return f"remap=[{_quoted(pairs)}]"
    try:
        rules = [pair if isinstance(pair, (str, Remap)) else "{}:={}".format(*pair) for pair in pairs]
    except (TypeError, IndexError):
        return 'remap=["from:=to"]'
    return f"remap=[{', '.join(_quoted(str(rule)) for rule in rules)}]"


def _quoted(value: object) -> str:
    return f'"{value}"' if isinstance(value, str) and '"' not in value else repr(value)
