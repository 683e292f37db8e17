"""A graph file's changes to a node's groups, and the YAML for them with one more change.

Users paste a remedy over the node's `concurrency:` as a whole, so it must repeat everything that the file has already.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from graphflow.interface import GroupChange
from graphflow.machines.waits.wrapping import WIDTH

THREADS = "blocking"
"""Name of the group for handlers that run in threads."""


@dataclass(frozen=True, slots=True)
class Regrouping:
    """The differences from the groups that a node's class declares.

    Attributes:
        groups: The changes, by group name.
        file: The graph file to write them to; empty for a node that was started without one.
        section: The key of that file with the node's entry: `override` for a node that comes from an include.
        line: The line of that entry; 0 if there is none.
    """

    groups: Mapping[str, GroupChange] = field(default_factory=dict)
    file: str = ""
    section: str = "nodes"
    line: int = 0

    def moved(self, handlers: Sequence[str], group: str, *, thread: bool | None = None) -> Regrouping:
        """Return a copy with handlers in one group, and in no other."""
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
        """Return a copy with handlers in a group whose `def` handlers run in threads."""
        return self.moved(handlers, THREADS, thread=True)

    def limited(self, group: str, limit: int | None) -> Regrouping:
        """Return a copy with another limit of a group."""
        here = self.groups.get(group, GroupChange())
        return replace(self, groups={**self.groups, group: replace(here, limit=limit, sets_limit=True)})

    @property
    def where(self) -> str:
        """Phrase for the place in the graph file to write the changes to."""
        if self.line:
            return f"as the concurrency: of the entry at {self.file}:{self.line}"
        return f"in {self.file or 'the graph file'} under {self.section}:"

    def lines(self, node: str, indent: str) -> list[str]:
        """Return the changes as YAML, for a place below `nodes:` or `override:`."""
        groups = [f"{name}: {_flow(plain(change))}" for name, change in self.groups.items()]
        short = f"{indent}{node}: {{concurrency: {{{', '.join(groups)}}}}}"
        if len(short) <= WIDTH:
            return [short]
        return [f"{indent}{node}:", f"{indent}  concurrency:", *(f"{indent}    {line}" for line in groups)]


def plain(change: GroupChange) -> list[str] | dict[str, object]:
    """Convert a change of a group to the plain data of a graph file."""
    more: dict[str, object] = {}
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
    """Format plain data as YAML in flow style."""
    match value:
        case bool():
            return "true" if value else "false"
        case list():
            return f"[{', '.join(map(_flow, value))}]"
        case dict():
            return f"{{{', '.join(f'{key}: {_flow(part)}' for key, part in value.items())}}}"
    return str(value)
