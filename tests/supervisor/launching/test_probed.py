"""The answer of a process that has imported classes."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

from graphflow.errors import Place, Problem
from graphflow.interface import Interface
from graphflow.supervisor.launching.classes import interfaces
from graphflow.supervisor.launching.probed import read_interfaces, slips_in


def test_an_answer_is_read() -> None:
    """An Interface for each class that could be imported, and a problem for each other."""
    told: Any = interfaces(["graphflow.nodes.talker:Talker"])
    read = read_interfaces({**told, "a:A": {"problem": "there is no module a"}})
    talker = read["graphflow.nodes.talker:Talker"]
    assert isinstance(talker, Interface)
    assert [param.name for param in talker.params] == [*talker_params(told)]
    assert read["a:A"] == Problem(Place(""), "there is no module a")


def test_slips_are_told_once() -> None:
    """Two classes may have one of their parent's; where they were not asked for there are none."""
    assert slips_in({"a:A": {"slips": ["x", "y"]}, "a:B": {"slips": ["y", "z"]}, "a:C": {}}) == ["x", "y", "z"]
    found = interfaces(["graphflow.nodes.talker:Talker"], with_slips=True)
    assert slips_in(found) == slips_in(interfaces(["graphflow.nodes.talker:Talker"])) == []


def test_slips_that_a_graph_file_may_prevent() -> None:
    """They are left out for classes whose groups it changes."""
    data: Any = {"a:A": {"slips": ["x"], "slips_in_groups": ["y"]}}
    assert slips_in(data) == ["x", "y"]
    assert slips_in(data, ["a:A"]) == ["x"]


def talker_params(told: dict[str, dict[str, list[dict[str, str]]]]) -> list[str]:
    """The names of its parameters in the JSON."""
    return [param["name"] for param in told["graphflow.nodes.talker:Talker"]["params"]]


def test_it_needs_nothing_that_runs_nodes() -> None:
    """A supervisor reads it before it imports that."""
    program = "import sys, graphflow.supervisor.launching.probed; print('graphflow.runtime.node' in sys.modules)"
    assert subprocess.check_output([sys.executable, "-c", program], text=True).strip() == "False"
