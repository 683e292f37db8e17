"""Markers in Rerun."""

from __future__ import annotations

import pytest

rr = pytest.importorskip("rerun", reason="the extra `rerun` is not installed")

from graphflow.msgs.geometry_msgs.msg import Point
from graphflow.msgs.std_msgs.msg import Header
from graphflow.msgs.visualization_msgs.msg import Marker, MarkerArray
from graphflow.viewer.rerun.archetypes import shown


@pytest.mark.parametrize(
    ("kind", "archetype"),
    [
        (Marker.CUBE, rr.Boxes3D),
        (Marker.SPHERE, rr.Ellipsoids3D),
        (Marker.CYLINDER, rr.Cylinders3D),
        (Marker.ARROW, rr.Arrows3D),
        (Marker.LINE_STRIP, rr.LineStrips3D),
        (Marker.LINE_LIST, rr.LineStrips3D),
        (Marker.POINTS, rr.Points3D),
        (Marker.TEXT_VIEW_FACING, rr.Points3D),
        (Marker.TRIANGLE_LIST, rr.Mesh3D),
    ],
)
def test_markers(kind: int, archetype: type) -> None:
    """Each kind has its archetype, in its frame; a deleted one is cleared."""
    points = [Point(x=float(i)) for i in range(6)]
    marker = Marker(header=Header(frame_id="map"), ns="a", id=7, type=kind, points=points)
    first, _ = shown("/m", "visualization_msgs/msg/MarkerArray", MarkerArray(markers=[marker]))
    assert first[:2] == ("m/a/7", "map")
    assert isinstance(first[2], archetype)
    marker.action = Marker.DELETE
    [(path, _, cleared)] = shown("/m", "visualization_msgs/msg/Marker", marker)
    assert (path, type(cleared)) == ("m/a/7", rr.Clear)
    marker.action = Marker.DELETEALL
    assert [path for path, _, _ in shown("/m", "visualization_msgs/msg/Marker", marker)] == ["m"]
