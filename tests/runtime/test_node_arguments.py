"""Arguments of nodes in other words and shapes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from graphflow import InvalidName, Node, Param, ParameterError
from graphflow.names import Remap
from graphflow.runtime.node_arguments import instead_of, rules_of
from graphflow.runtime.node_core import core_of
from tests.cases import slow
from tests.conftest import LIMIT

WANTED = 'remap=["goal:=/turtle1/pose"]'


@pytest.mark.parametrize(
    ("remap", "told"),
    [
        ({"goal": "/turtle1/pose"}, f"remap= takes a list: {WANTED}"),
        ("goal:=/turtle1/pose", f"remap= takes a list: {WANTED}"),
        ([("goal", "/turtle1/pose")], f"a rule is a string: {WANTED}"),
    ],
)
def test_rules_in_another_shape(remap: Any, told: str) -> None:
    """The error has the user's line."""
    with pytest.raises(InvalidName) as caught:
        Node("n", remap=remap)
    place, _, text = str(caught.value).partition(": ")
    assert place.startswith(__file__)
    assert text == told


def test_rules() -> None:
    """Texts and objects."""
    rule = Remap("a", "b")
    assert rules_of([rule, "a:=b"]) == [rule, rule]
    assert rules_of(()) == []


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"ns": "/turtle2"}, 'write namespace="/turtle2"'),
        ({"remappings": [("goal", "/turtle1/pose")]}, f"write {WANTED}"),
        ({"remaps": "goal:=/turtle1/pose"}, f"write {WANTED}"),
        ({"remaps": 3}, 'write remap=["from:=to"]'),
        ({"params": {"gain": 2.0}}, "pass parameters by name: gain=2.0"),
        ({"parameters": [{"gain": 2.0}]}, "pass parameters by name: gain=5.0"),
        ({"node_name": "bob"}, 'write name="bob"'),
        ({"gian": 2.0}, "did you mean 'gain'?"),
    ],
)
def test_other_words(given: dict[str, Any], told: str) -> None:
    """Keywords that would be parameters, which the class does not have."""

    class Robot(Node):
        gain = Param(5.0)

    with pytest.raises(ParameterError) as caught:
        core_of(Robot(**given)).ensure_made()
    assert str(caught.value).endswith(f"(from argument); {told}")


def test_a_parameter_of_that_name() -> None:
    """It is one like others."""

    class Robot(Node):
        ns = Param("a")

    robot = Robot(ns="b")
    core_of(robot).ensure_made()
    assert robot.ns == "b"
    assert instead_of("gain", 1.0) == ""


TALK = "import graphflow\n\nclass Talk(graphflow.Node):\n    pass\n\n"


@slow
@pytest.mark.parametrize(
    ("line", "told"),
    [
        (
            'graphflow.run(Talk, namespace="/a")',
            'namespace= belongs to the node: graphflow.run(Talk(namespace="/a")), or',
        ),
        ('graphflow.run(Talk(), ns="/a")', 'ns= belongs to the node: graphflow.run(Talk(namespace="/a")), or'),
        ("Talk().run()", "AttributeError: 'Talk' object has no attribute 'run'\n"),
    ],
)
def test_a_program(tmp_path: Path, line: str, told: str) -> None:
    """It ends with the line to write."""
    (tmp_path / "talk.py").write_text(TALK + line + "\n")
    done = subprocess.run([sys.executable, "talk.py"], cwd=tmp_path, capture_output=True, text=True, timeout=LIMIT)
    assert told in done.stderr
    assert done.returncode == (1 if "Attribute" in told else 2)
    if "Attribute" in told:
        assert done.stderr.endswith("has no attribute 'run'; run nodes with graphflow.run(Talk)\n")
