"""The deadlocks and races that `graphflow demo` shows, in the order of the lesson."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from graphflow.workspace.project import demos_root


class Step(NamedTuple):
    """A pair of graphs, `NAME_broken` and `NAME_fixed`."""

    name: str
    seconds: float
    """Running time of the fixed graph, and of the broken one if no deadlock is found."""


DEADLOCKS = (
    Step("self_call", 3.5),
    Step("classic", 3.5),
    Step("blocked_loop", 3.5),
    Step("crossing", 3.5),
    Step("event", 4.0),
    Step("recursion", 2.0),
    Step("goal_on_loop", 6.0),
    Step("goal_in_threads", 6.0),
    Step("goal_async", 6.0),
    Step("arrival_race", 9.0),
    Step("arrival", 9.0),
)


def graph_file(name: str, kind: str) -> Path:
    """Return the graph file of a step; `kind` is `broken` or `fixed`."""
    return demos_root() / "graphs" / "deadlock" / f"{name}_{kind}.yaml"


def heading(file: Path) -> str:
    """Return a graph file's heading: its first line, or the second if the first is for editors."""
    lines = file.read_text(encoding="utf-8").splitlines()
    return lines[lines[0].startswith("# yaml-language-server:")].lstrip("# ")
