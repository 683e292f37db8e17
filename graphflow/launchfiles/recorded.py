"""Launch actions recorded from a launch file in Python, and their form in JSON.

A launch file in Python runs in a process of its own; its description comes back as JSON.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias, TypedDict

from graphflow.markup.source import Data


class Finding(TypedDict):
    """A problem or a remark in a launch file."""

    line: int
    message: str


class Description(TypedDict):
    """The description of a launch file, as its process returns it."""

    actions: list[dict[str, Data]]
    """As `Action.to_json` makes them."""
    problems: list[Finding]
    """Parts that a graph file cannot express."""
    remarks: list[Finding]
    """Parts that are left out."""


Describe: TypeAlias = Callable[[Path, str, Mapping[str, object] | None], Description]
"""Runs a launch file in Python; takes the file, its name in messages, and its arguments."""


@dataclass
class Action:
    """A launch action, with its name and attributes in the YAML launch dialect."""

    name: str
    attributes: dict[str, Data]
    line: int = 1
    children: list[Action] | None = None
    """The actions of a group or a timer."""
    number: int | None = None
    """The number by which other actions name this one as their predecessor."""
    after_number: int | None = None
    """The number of its predecessor."""
    after_what: str | None = None
    """The state of the predecessor that it waits for: `ready` or `exited`."""
    brought_to: str | None = None
    """The lifecycle state to which events bring this node."""

    def relations(self) -> dict[str, Data]:
        """Return the attributes that the YAML dialect does not have, as far as they are set."""
        found: dict[str, Data] = {
            "number": self.number,
            "after_number": self.after_number,
            "after_what": self.after_what,
            "brought_to": self.brought_to,
        }
        return {key: value for key, value in found.items() if value is not None}

    def to_json(self) -> dict[str, Data]:
        """Return the action as a mapping from its name to its attributes, which `from_json` reads."""
        children: dict[str, Data] = {}
        if self.children is not None:
            children["children"] = [child.to_json() for child in self.children]
        return {self.name: {**self.attributes, **children, "line": self.line, **self.relations()}}

    @classmethod
    def from_json(cls, data: Mapping[str, Data]) -> Action:
        """Read an action from JSON."""
        [(name, attributes)] = data.items()
        assert isinstance(attributes, dict)
        action = cls(name, {key: value for key, value in attributes.items() if key not in _FIELDS})
        for key in _FIELDS & attributes.keys():
            value = attributes[key]
            if isinstance(value, list):
                setattr(action, key, [cls.from_json(child) for child in value if isinstance(child, dict)])
            else:
                setattr(action, key, value)
        return action


_FIELDS = frozenset(("line", "children", "number", "after_number", "after_what", "brought_to"))
