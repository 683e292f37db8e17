"""Nodes under a debugger."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from graphflow.errors import GraphFileError, GraphflowError, Place
from graphflow.graph.plan import Plan, PlannedNode
from graphflow.supervisor.launching.debugging import debugged, wait_for_debugger
from tests.cases import slow
from tests.conftest import Machine

HERE = Place("g.yaml", 1)
FAKE = """
import time
from pathlib import Path

def listen(address):
    return address[0], 4711

def wait_for_client():
    while not Path(__file__).with_name("attached").exists():
        time.sleep(0.01)
"""


def plan() -> Plan:
    talker = PlannedNode("/talker", "nodes.talker:Talker", HERE, HERE)
    program = PlannedNode("/top", "", HERE, HERE, command=("top",))
    return Plan("g", "g.yaml", "/", (talker, program))


def test_a_plan_with_a_node_to_debug() -> None:
    """Its calls wait for ever, and the others' do."""
    made = debugged(plan(), ["talker"])
    assert [node.is_debugged for node in made.nodes] == [True, False]
    assert made.call_timeout is None


@pytest.mark.parametrize(
    ("name", "told"),
    [("talkr", "the graph has no node /talkr; did you mean '/talker'?"), ("/top", "/top is a foreign program")],
)
def test_what_cannot_be_debugged(name: str, told: str) -> None:
    """Is a mistake on the command line."""
    with pytest.raises(GraphFileError) as error:
        debugged(plan(), [name])
    assert f"command line: --debug: {told}" in str(error.value)


def test_without_debugpy(monkeypatch: pytest.MonkeyPatch) -> None:
    """The error names the package to install."""
    monkeypatch.setitem(sys.modules, "debugpy", None)
    with pytest.raises(GraphflowError, match="pip install debugpy"):
        wait_for_debugger(lambda port: None)


def test_the_port_is_told_before_the_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    """A user must find the waiting process."""
    story: list[Any] = []
    fake: Any = ModuleType("debugpy")
    fake.listen = lambda address: (address[0], 4711)
    fake.wait_for_client = lambda: story.append("waits")
    monkeypatch.setitem(sys.modules, "debugpy", fake)
    wait_for_debugger(lambda port: story.append(port))
    assert story == [4711, "waits"]


@slow
@pytest.mark.real
def test_a_node_waits_for_its_debugger(machine: Machine, tmp_path: Path) -> None:
    """The port is told; the other nodes go on; when a debugger has attached, so does it."""
    (tmp_path / "debugpy.py").write_text(FAKE)
    machine.env["PYTHONPATH"] = str(tmp_path)
    up = machine.start("up", "--no-console", "--debug", "/listener", "graphs/talker_listener.yaml", "rate:=50.0")
    up.wait_for("/listener waits for a debugger on 127.0.0.1:4711")
    up.wait_for("Publishing: 'Hello World: 9'")
    assert "is up" not in up.text
    (tmp_path / "attached").touch()
    up.wait_for("graph talker_listener is up: 2 nodes")
    up.wait_for("I heard")
