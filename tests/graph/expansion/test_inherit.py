"""What groups give to the nodes within them."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.errors import Place
from graphflow.graph.expansion.inherit import with_groups
from graphflow.markup.tree import located

HERE = Place("f.yaml", 1, 1)


@pytest.mark.parametrize(
    ("node", "groups", "expected"),
    [
        ({"class": "a:B"}, [{"restart": "always"}, {"restart": "never"}], {"class": "a:B", "restart": "always"}),
        ({"class": "a:B", "critical": True}, [{"critical": False}], {"class": "a:B", "critical": True}),
        ({"exec": "a.py"}, [{"lifecycle": "active", "on_exit": "shutdown"}], {"exec": "a.py", "on_exit": "shutdown"}),
        (
            {"env": {"A": "own"}, "params": {"x": 1}},
            [{"env": {"A": "inner", "B": "inner"}, "params": {"y": 2}}, {"params": {"y": 3, "z": 4}}],
            {"env": {"A": "own", "B": "inner"}, "params": {"x": 1}, "params of groups": {"y": 2, "z": 4}},
        ),
        (
            {"params_file": "own.yaml"},
            [{"params_file": ["b.yaml", "c.yaml"]}, {"params_file": "a.yaml"}],
            {"params_file": "own.yaml", "params_file of groups": ["a.yaml", "b.yaml", "c.yaml"]},
        ),
    ],
)
def test_the_nearest_says_it(node: Any, groups: list[Any], expected: Any) -> None:
    """First the node, then the innermost group; variables and parameters one by one."""
    given = [located(group, HERE).entries for group in groups]
    assert with_groups(located(node, HERE), given).plain() == expected
