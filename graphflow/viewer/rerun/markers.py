"""Markers of visualization_msgs for Rerun. Source: visualization_msgs/msg/Marker."""

from __future__ import annotations

from collections.abc import Iterator

import rerun as rr

from graphflow.msgs.std_msgs.msg import ColorRGBA
from graphflow.msgs.visualization_msgs.msg import Marker, MarkerArray
from graphflow.viewer.rerun.shapes import Logged

POINTS_BOUND = 1_000_000
"""Points of one marker that are shown, at most."""


def marker_shapes(path: str, message: Marker | MarkerArray) -> Iterator[Logged]:
    """Yield the shapes of a marker, or of several; one that is deleted is cleared."""
    markers = message.markers if isinstance(message, MarkerArray) else [message]
    for marker in markers:
        if marker.action == Marker.DELETEALL:
            yield path, "", rr.Clear(recursive=True)
            continue
        own = f"{path}/{marker.ns or 'marker'}/{marker.id}"
        if marker.action == Marker.DELETE:
            yield own, "", rr.Clear(recursive=True)
            continue
        made = _archetype(marker)
        if made is not None:
            pose = marker.pose
            at, turn = pose.position, pose.orientation
            quaternion = [turn.x, turn.y, turn.z, turn.w]
            yield own, marker.header.frame_id, made
            yield (
                own,
                marker.header.frame_id,
                rr.InstancePoses3D(
                    translations=[[at.x, at.y, at.z]], quaternions=[quaternion if any(quaternion) else [0, 0, 0, 1]]
                ),
            )


def _archetype(marker: Marker) -> rr.AsComponents | None:
    scale, points = marker.scale, [(p.x, p.y, p.z) for p in marker.points[:POINTS_BOUND]]
    colours = [_colour(c) for c in marker.colors[:POINTS_BOUND]] or [_colour(marker.color)]
    match marker.type:
        case Marker.CUBE:
            return rr.Boxes3D(sizes=[[scale.x, scale.y, scale.z]], colors=colours, fill_mode="solid")
        case Marker.SPHERE:
            return rr.Ellipsoids3D(
                half_sizes=[[scale.x / 2, scale.y / 2, scale.z / 2]], colors=colours, fill_mode="solid"
            )
        case Marker.CYLINDER:
            return rr.Cylinders3D(radii=[scale.x / 2], lengths=[scale.z], colors=colours, fill_mode="solid")
        case Marker.ARROW:
            ends = points[:2] if len(points) >= 2 else [(0.0, 0.0, 0.0), (scale.x, 0.0, 0.0)]
            way = [b - a for a, b in zip(*ends, strict=True)]
            return rr.Arrows3D(origins=[ends[0]], vectors=[way], colors=colours)
        case Marker.LINE_STRIP:
            return rr.LineStrips3D([points], radii=[scale.x / 2], colors=colours[:1])
        case Marker.LINE_LIST:
            pairs = [points[i : i + 2] for i in range(0, len(points) - 1, 2)]
            return rr.LineStrips3D(pairs, radii=[scale.x / 2], colors=colours[:1])
        case Marker.POINTS | Marker.SPHERE_LIST | Marker.CUBE_LIST:
            return rr.Points3D(points, radii=[scale.x / 2], colors=colours)
        case Marker.TEXT_VIEW_FACING:
            return rr.Points3D([[0.0, 0.0, 0.0]], labels=[marker.text], colors=colours, show_labels=True)
        case Marker.TRIANGLE_LIST:
            return rr.Mesh3D(vertex_positions=points, vertex_colors=colours if len(colours) > 1 else None)
    return None


def _colour(colour: ColorRGBA) -> list[int]:
    return [min(255, max(0, round(255 * part))) for part in (colour.r, colour.g, colour.b, colour.a)]
