"""Actions and attributes that a graph file can express."""

from __future__ import annotations

import pytest

from graphflow.errors import Place
from graphflow.launchfiles.known_actions import is_known
from graphflow.markup.source import Data
from graphflow.markup.tree import located

ELSEWHERE = "write env: in a group or at a node"
HERE = Place("f.launch.yaml", 1, 1)


@pytest.mark.parametrize(
    ("name", "attributes", "known", "faults"),
    [
        ("log", {"message": "a"}, True, []),
        ("log", {"mesage": "a"}, True, ["log: unknown attribute 'mesage'; did you mean 'message'?"]),
        ("node", {"package": "p"}, True, ["node: unknown attribute 'package'; it is called 'pkg' here"]),
        ("log", "a", False, ["log: expected a mapping of its attributes, got 'a'"]),
        ("nod", {}, False, ["the action 'nod' has no equivalent in a graph file; did you mean 'node'?"]),
        (
            "unset_env",
            {},
            False,
            ["the action 'unset_env' has no equivalent in a graph file: write env: in a group or at a node"],
        ),
    ],
)
def test_actions(name: str, attributes: Data, known: bool, faults: list[str]) -> None:
    """An unknown attribute is reported and the action converted; an unknown action is not."""
    found: list[str] = []
    assert is_known(name, located(attributes, HERE), lambda _, text: found.append(text)) is known
    assert found == faults
