"""Nodes of graph files that are written as ROS's pairs of package and executable."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from graphflow.graph.expansion.ros_pairs import as_class
from graphflow.markup import source
from graphflow.markup.tree import Item, tree


def read(text: str) -> Item:
    return tree(source.read(text, "g.yaml"))


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (
            "{pkg: turtlesim, exec: turtlesim_node, params: {a: 1}}",
            {"class": "nodes.turtlesim:TurtleSim", "params": {"a": 1}},
        ),
        (
            "{pkg: slam_toolbox, exec: async_slam_toolbox_node, lifecycle: active}",
            {"class": "nodes.mapper:Mapper"},  # it has no life cycle, and ROS's has one
        ),
        ("{pkg: turtlesim, exec: nonsense}", {"pkg": "turtlesim", "exec": "nonsense"}),
        ("{pkg: turtlesim, exec: turtlesim_node, class: a:B}", None),
        ("{class: a:B}", None),
        ("{pkg: 1, exec: turtlesim_node}", None),
    ],
)
def test_a_pair(text: str, found: dict[str, Any] | None, tmp_path: Path) -> None:
    """A pair that is a class here is that class; any other node stays as it is."""
    node = read(text)
    assert as_class(node, tmp_path).plain() == (node.plain() if found is None else found)
