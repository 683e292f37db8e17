"""What a graph file says of a node's groups, and how it reads with one thing changed.

A graph file's `concurrency:` is pasted as a whole: whatever a remedy prints has to keep all that the file says already.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from graphflow.interface import GroupChange
from graphflow.machines.waits.wrapping import WIDTH

THREADS = "blocking"
"""The group of handlers that are put in threads."""


@dataclass(frozen=True, slots=True)
class Regrouping:
    """What differs from the groups that a node's class declares.

    Attributes:
        groups: The changes by group name.
        file: The graph file to write them to; empty where the node was started without one.
        section: The key of that file under which the node is written: `override` for one that comes from an include.
        line: Where its entry is in that file; 0 if it has none.
    """

    groups: Mapping[str, GroupChange] = field(default_factory=dict)
    file: str = ""
    section: str = "nodes"
    line: int = 0

    def moved(self, handlers: Sequence[str], group: str, *, thread: bool | None = None) -> Regrouping:
        """The same with handlers in that group, and in no other."""
        left: dict[str, GroupChange] = {}
        for name, change in self.groups.items():
            rest = tuple(h for h in change.handlers if h not in handlers)
            kept = replace(change, handlers=rest)
            if name == group or rest or kept != GroupChange():
                left[name] = kept
        here = left.get(group, GroupChange())
        left[group] = replace(
            here, handlers=(*here.handlers, *handlers), thread=here.thread if thread is None else thread
        )
        return replace(self, groups=left)

    def in_threads(self, handlers: Sequence[str]) -> Regrouping:
        """The same with handlers in a group whose `def` handlers run in threads."""
        return self.moved(handlers, THREADS, thread=True)

    def limited(self, group: str, limit: int | None) -> Regrouping:
        """The same with another limit of a group."""
        here = self.groups.get(group, GroupChange())
        return replace(self, groups={**self.groups, group: replace(here, limit=limit, sets_limit=True)})

    @property
    def where(self) -> str:
        """The place in the graph file to write it to, in words."""
        if self.line:
            return f"as the concurrency: of the entry at {self.file}:{self.line}"
        return f"in {self.file or 'the graph file'} under {self.section}:"

    def lines(self, node: str, indent: str) -> list[str]:
        """YAML that says it, for a place below `nodes:` or `override:`."""
        groups = [f"{name}: {_flow(plain(change))}" for name, change in self.groups.items()]
        short = f"{indent}{node}: {{concurrency: {{{', '.join(groups)}}}}}"
        if len(short) <= WIDTH:
            return [short]
        return [f"{indent}{node}:", f"{indent}  concurrency:", *(f"{indent}    {line}" for line in groups)]


def plain(change: GroupChange) -> list[str] | dict[str, Any]:
    """A change of a group as plain data, as a graph file has it."""
    more: dict[str, Any] = {}
    if change.sets_limit:
        more["limit"] = "none" if change.limit is None else change.limit
    if change.when_full is not None:
        more["when_full"] = change.when_full
    if change.thread is not None:
        more["thread"] = change.thread
    members = list(change.handlers)
    if not more:
        return members
    return {"handlers": members, **more} if members else more


def _flow(value: object) -> str:
    """Plain data as YAML on one line."""
    match value:
        case bool():
            return "true" if value else "false"
        case list():
            return f"[{', '.join(map(_flow, value))}]"
        case dict():
            return f"{{{', '.join(f'{key}: {_flow(part)}' for key, part in value.items())}}}"
    return str(value)
