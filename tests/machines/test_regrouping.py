"""What a graph file says of groups, with one thing changed."""

from __future__ import annotations

from dataclasses import replace

import pytest
import yaml

from graphflow.interface import GroupChange
from graphflow.machines.regrouping import Regrouping, plain

SAID = Regrouping({"motion": GroupChange(("tick", "stop")), "io": GroupChange((), 2, sets_limit=True)}, "lab.yaml")


@pytest.mark.parametrize(
    ("change", "data"),
    [
        (GroupChange(("a", "b")), ["a", "b"]),
        (GroupChange(("a",), 3, sets_limit=True), {"handlers": ["a"], "limit": 3}),
        (GroupChange((), None, sets_limit=True), {"limit": "none"}),
        (
            GroupChange(("a",), when_full="drop_old", thread=True),
            {"handlers": ["a"], "when_full": "drop_old", "thread": True},
        ),
    ],
)
def test_a_change_as_a_graph_file_has_it(change: GroupChange, data: object) -> None:
    """And it reads the same on the line that is printed."""
    assert plain(change) == data
    [line] = Regrouping({"g": change}).lines("/arm", "  ")
    assert yaml.safe_load(line) == {"/arm": {"concurrency": {"g": data}}}


def test_a_handler_that_moves() -> None:
    """It is in one group only, and one that is left empty, without any other word, goes."""
    assert SAID.moved(["stop"], "own").groups == {
        "motion": GroupChange(("tick",)),
        "io": SAID.groups["io"],
        "own": GroupChange(("stop",)),
    }
    alone = Regrouping({"motion": GroupChange(("tick",))})
    assert alone.moved(["tick"], "own").groups == {"own": GroupChange(("tick",))}
    assert SAID.moved(["stop"], "io").groups["io"] == GroupChange(("stop",), 2, sets_limit=True)
    assert SAID.moved(["tick"], "blocking", thread=True).groups["blocking"] == GroupChange(("tick",), thread=True)


def test_another_limit() -> None:
    """Members stay."""
    assert SAID.limited("motion", 2).groups["motion"] == GroupChange(("tick", "stop"), 2, sets_limit=True)
    assert SAID.limited("new", 2).groups["new"] == GroupChange((), 2, sets_limit=True)


def test_where_it_is_written() -> None:
    """The file and its section; without a file, whichever comes."""
    assert SAID.where == "in lab.yaml under nodes:"
    assert replace(SAID, line=6).where == "as the concurrency: of the entry at lab.yaml:6"
    assert Regrouping().where == "in the graph file under nodes:"


def test_a_long_one_takes_several_lines() -> None:
    """It is YAML all the same."""
    long = Regrouping({f"group_{i}": GroupChange((f"handler_{i}", f"other_{i}")) for i in range(6)})
    lines = long.lines("/arm", "    ")
    assert len(lines) == 8
    assert len(yaml.safe_load("\n".join(lines))["/arm"]["concurrency"]) == 6
