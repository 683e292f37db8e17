"""The default first window."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.tui.feeds.hub import Hub
from graphflow.tui.home import open_home
from graphflow.tui.layout import Layout
from graphflow.tui.panes import Split
from tests.tui.stage import Supervised

pytestmark = pytest.mark.usefixtures("graphflow_runner")


@pytest.mark.parametrize(
    ("class_path", "views", "focused"),
    [
        ("nodes.turtlesim:TurtleSim", ["nodes", "detail", "turtle"], "turtle"),
        ("nodes.robot_simulator:RobotSimulator", ["nodes", "detail", "map"], "map"),
        ("nodes.talker:Talker", ["nodes", "detail"], "nodes"),
    ],
)
async def test_the_turtle_where_there_is_one(class_path: str, views: list[str], focused: str, tmp_path: Path) -> None:
    """A turtle is shown if the graph has one; otherwise nodes and logs only."""
    supervision = Supervised(["/a"], tmp_path)
    supervision.nodes["/a"]["class"] = class_path
    layout = Layout()
    open_home(layout, Hub(0, supervision, (), dict))
    assert [pane.content.view for pane in layout.window.panes()] == views
    assert layout.window.pane(layout.window.focused).content.view == focused
    assert len(layout.window.places(80, 22)) == len(views), "it fits 80 x 24"


@pytest.mark.parametrize(("nodes", "columns", "axis"), [(40, 120, "columns"), (40, 80, "rows"), (4, 120, "rows")])
def test_many_nodes_have_the_whole_height(nodes: int, columns: int, axis: str, tmp_path: Path) -> None:
    """With many nodes and a wide terminal, the list takes the whole height, with the details beside it."""
    supervision = Supervised([f"/n{i}" for i in range(nodes)], tmp_path)
    layout = Layout()
    open_home(layout, Hub(0, supervision, (), dict), columns)
    root = layout.window.root
    assert isinstance(root, Split)
    assert root.axis == axis
