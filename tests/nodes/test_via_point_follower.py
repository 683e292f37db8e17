"""A turtle on a round trip."""

import logging
import math

import pytest

from graphflow import ParameterError
from graphflow.msgs.turtlesim.msg import Pose
from graphflow.testing import Graph
from nodes.turtlesim import TurtleSim
from nodes.via_point_follower import ViaPointFollower
from tests.cases import slow


def test_it_has_what_its_parent_has() -> None:
    """Its parameters come after those it inherits."""
    interface = ViaPointFollower.interface()

    assert interface.node_name == "via_point_follower"
    assert [p.name for p in interface.params] == ["gain", "speed", "tolerance", "via_x", "via_y"]
    assert {e.name for e in interface.endpoints} == {"cmd_vel", "pose"}


@slow
async def test_it_visits_all_six_points_in_order_and_begins_again(
    graph: Graph, caplog: pytest.LogCaptureFixture
) -> None:
    """The pose comes within the tolerance of each point, with a log message."""
    caplog.set_level(logging.INFO)
    await graph.start(TurtleSim(), ViaPointFollower(namespace="/turtle1"))
    poses = graph.tap(Pose, "/turtle1/pose")

    await graph.clock.advance(60.0)

    points = [(2, 1), (5, 9), (8, 1), (1, 6), (9, 6), (2, 1)]
    texts = [m for m in caplog.messages if m.startswith("arrived")]
    assert texts[:7] == [f"arrived at ({x}, {y})" for x, y in [*points, points[0]]]
    for point in points:
        assert min(math.dist((p.x, p.y), point) for p in poses) <= 0.1


async def test_points_are_parameters(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Integers are accepted as floats."""
    caplog.set_level(logging.INFO)
    await graph.start(TurtleSim(), ViaPointFollower(namespace="/turtle1", via_x=[6, 6.5], via_y=[6, 5]))

    await graph.clock.advance(10.0)

    assert [m for m in caplog.messages if m.startswith("arrived")][:2] == ["arrived at (6, 6)", "arrived at (6.5, 5)"]


@pytest.mark.parametrize(("xs", "ys"), [([1.0, 2.0], [1.0]), ([1.0], [1.0, 2.0]), ([], [])])
def test_lists_that_do_not_fit_are_refused(xs: list[float], ys: list[float]) -> None:
    """The node is not made, and the error has both numbers."""
    with pytest.raises(ParameterError, match=f"via_x has {len(xs)} numbers but via_y has {len(ys)}"):
        ViaPointFollower(via_x=xs, via_y=ys)


def test_points_cannot_change_later() -> None:
    """They would not fit together between two changes."""
    with pytest.raises(ParameterError, match="read-only"):
        ViaPointFollower().via_x = [1.0]
