"""A frame beside a turtle."""

import math

import pytest

from graphflow import Node
from graphflow.testing import Graph
from graphflow.tf import Transforms
from nodes.carrot_broadcaster import CarrotBroadcaster


class Listener(Node):
    tf = Transforms()


@pytest.mark.parametrize(("moves", "distance"), [(False, 2.0), (True, 10.0)])
async def test_it_stays_or_circles(graph: Graph, moves: bool, distance: float) -> None:
    """It keeps its distance to the turtle."""
    listener = Listener()
    await graph.start(listener, CarrotBroadcaster(moves=moves))
    places = []
    for _ in range(3):
        await graph.clock.advance(0.3)
        places.append(listener.tf.get("turtle1", "carrot1").translation)
    assert [math.hypot(x, y) for x, y, _ in places] == pytest.approx([distance] * 3)
    assert (len(set(places)) > 1) is moves
