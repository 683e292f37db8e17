"""`graphflow graph`: drawn in the terminal, and for others."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real


@slow
def test_in_the_terminal(standing: Machine) -> None:
    """Nodes have round boxes, topics square ones; incompatible topics are marked, with the verb for details."""
    text = standing.look("graph")
    assert "│ /talker │" in text
    assert "▶│ /chatter │" in text
    assert "! /office/minutes" in text
    assert "! /office/minutes is incompatible: graphflow topic info -v /office/minutes\n" in text
    assert "/rosout" not in text
    assert "/rosout" in standing.look("graph", "--all")


@slow
def test_a_part(standing: Machine) -> None:
    """Of one namespace."""
    text = standing.look("graph", "office")
    assert "/office/clerk" in text
    assert "/talker" not in text
    assert standing.look("graph", "ofice", code=1) == (
        "error: there is no node /ofice, and none below that name; did you mean '/office'?\n"
    )


@slow
def test_for_others(standing: Machine, tmp_path: Path) -> None:
    """Graphviz, Mermaid, a file."""
    assert standing.look("graph", "--dot").startswith("digraph graphflow {\n")
    assert '["/chatter"]' in standing.look("graph", "--mermaid")
    assert standing.look("graph", "--svg", "g.svg", cwd=tmp_path) == "g.svg\n"
    assert "/talker" in (tmp_path / "g.svg").read_text().replace("&#160;", " ")
    assert "error: /nowhere/g.svg: " in standing.look("graph", "--svg", "/nowhere/g.svg", code=1)


def test_png(standing: Machine, tmp_path: Path) -> None:
    """By Graphviz; without it what else there is."""
    if shutil.which("dot") is None:
        assert "which is not installed; --svg FILE needs no other program" in standing.look(
            "graph", "--png", "x.png", code=1
        )
    else:
        standing.look("graph", "--png", "x.png", cwd=tmp_path)
        assert (tmp_path / "x.png").read_bytes().startswith(b"\x89PNG")


def test_nothing_runs(machine: Machine) -> None:
    """Ends with 3, as for other verbs that look."""
    assert "nothing is running" in machine.look("graph", code=3)


def test_for_programs(standing: Machine) -> None:
    """The same as JSON."""
    found = json.loads(standing.look("graph", "--json", "/office"))
    assert {"/office/clerk", "/office/auditor"} <= {*found["nodes"]}
    arrows = {(arrow["source"], arrow["target"]): arrow["fits"] for arrow in found["arrows"]}
    assert ("/office/clerk", "/office/minutes") in arrows
    assert arrows["/office/minutes", "/office/auditor"] is False
