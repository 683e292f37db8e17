"""Names that two nodes or steps have."""

from __future__ import annotations

import pytest

from graphflow.errors import Place
from graphflow.graph.checks.taken_names import taken

HERE, BELOW, OTHER = Place("g.yaml", 3, 1), Place("g.yaml", 7, 1), Place("base.yaml", 2, 1)
ROUNDS = "this makes the node /a more than once: put the loop's variable into its name, or "


@pytest.mark.parametrize(
    ("what", "first", "is_included", "is_absolute", "text"),
    [
        ("nodes", BELOW, False, False, "there are two nodes /a; the other is on line 7"),
        ("nodes", HERE, True, False, f"{ROUNDS}give each include: of this file a namespace of its own"),
        ("nodes", HERE, True, True, f"{ROUNDS}leave out its slash and give each include: of this file a namespace of"),
        ("nodes", OTHER, False, False, "/a is already in the included file; change it under override:"),
        ("nodes", OTHER, True, True, "/a is already at base.yaml:2:1; give one of them another name, or one include:"),
        ("steps", OTHER, True, False, "there is a step '/a' already, at base.yaml:2:1; give this one another name"),
    ],
)
def test_the_remedy(what: str, first: Place, is_included: bool, is_absolute: bool, text: str) -> None:
    """It depends on where the first one is."""
    assert taken("/a", what, HERE, first, is_included=is_included, is_absolute=is_absolute).startswith(text)
