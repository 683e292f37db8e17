"""Whatever else a robot's map shows: the occupancy grid, the path, the goal, the footprint, and other robots."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from graphflow.errors import TransformError
from graphflow.tui.feeds.topic_monitor import TopicMonitor
from graphflow.tui.views.robot.topics import topics_of
from graphflow.tui.widgets.map_canvas import RobotDrawing

if TYPE_CHECKING:
    from graphflow.tf import Transform, TransformBuffer
    from graphflow.tui.feeds.graph_feed import Live

OCCUPIED = 65
"""Percent from which a cell is drawn."""
WALLS_BOUND, POINTS_BOUND, OTHERS_BOUND = 100_000, 2_000, 50
"""Cells, points of a path or an outline, and other robots that are drawn, at most."""
BASES = ("base_footprint", "base_link")
"""Frames of robots, after their names."""


class Layers:
    """The topics of one robot that belong on its map.

    Args:
        namespace: The robot's, in front of its topics; topics without one count, too.
    """

    def __init__(self, live: Live, drawing: RobotDrawing, tf: TransformBuffer, namespace: str) -> None:
        self._live, self._drawing, self._tf, self._namespace = live, drawing, tf, namespace
        self._frame = ""
        self._kinds: dict[str, tuple[str, str, Callable[[Any], None]]] = {
            "map": ("nav_msgs/msg/OccupancyGrid", "map", self._mapped),
            "path": ("nav_msgs/msg/Path", "plan", self._planned),
            "goal": ("geometry_msgs/msg/PoseStamped", "goal_pose", self._aimed),
            "footprint": ("geometry_msgs/msg/PolygonStamped", "footprint", self._outlined),
        }
        """The type, the usual end of the topic's name, and the method that takes a message."""
        self._monitors: dict[str, TopicMonitor] = {}
        self._seen: dict[str, tuple[int, str]] = {}

    def look(self, frame: str) -> None:
        """Take new messages; places are those in a fixed frame."""
        self._frame = frame
        for layer, (type_, usual, take) in self._kinds.items():
            monitor = self._monitors.get(layer)
            if monitor is None:
                topic = self._topic(type_, usual)
                if not topic:
                    continue
                monitor = self._monitors[layer] = TopicMonitor(self._live, topic)
            monitor.look()
            # A message is taken again when the fixed frame changes, and until its own frame is known.
            if monitor.message is not None and self._seen.get(layer) != (monitor.count, frame):
                try:
                    take(monitor.message)
                except TransformError:
                    continue
                self._seen[layer] = monitor.count, frame
        self._drawing.others = self._others()

    def _topic(self, type_: str, usual: str) -> str:
        """Return a topic of a type: of the robot, or of all; one with the usual name if there is one."""
        found = topics_of(self._live, type_)
        own = [topic for topic in found if topic.startswith(f"{self._namespace}/")] or found
        return next((topic for topic in own if topic.endswith(usual)), "")

    def _placed(self, frame: str) -> Transform:
        return self._tf.get(self._frame, frame or self._frame)

    def _mapped(self, message: Any) -> None:
        from graphflow.maps import GridMap

        try:
            grid = GridMap.from_msg(message)
        except ValueError:
            return
        rows, columns = np.nonzero(grid.cells >= OCCUPIED)
        step = -(-len(rows) // WALLS_BOUND) or 1
        centres = grid.centres(rows[::step], columns[::step])
        self._drawing.wall_size = grid.resolution * math.sqrt(step)
        points = np.column_stack([centres, np.zeros(len(centres))])
        self._drawing.walls = self._placed(message.header.frame_id).points(points)[:, :2]

    def _planned(self, message: Any) -> None:
        points = [(pose.pose.position.x, pose.pose.position.y) for pose in message.poses[:POINTS_BOUND]]
        self._drawing.path = self._moved(points, message.header.frame_id)

    def _outlined(self, message: Any) -> None:
        points = [(point.x, point.y) for point in message.polygon.points[:POINTS_BOUND]]
        self._drawing.footprint = self._moved(points, message.header.frame_id)

    def _moved(self, points: list[tuple[float, float]], frame: str) -> list[tuple[float, float]]:
        known = [(x, y, 0.0) for x, y in points if math.isfinite(x) and math.isfinite(y)]
        if not known:
            return []
        return [(float(x), float(y)) for x, y, _ in self._placed(frame).points(known)]

    def _aimed(self, message: Any) -> None:
        at = message.pose.position
        [(x, y)] = self._moved([(at.x, at.y)], message.header.frame_id) or [(0.0, 0.0)]
        self._drawing.goal = x, y

    def _others(self) -> dict[str, tuple[float, float, float]]:
        """Return the other robots: frames called `NAME/base_link`, as far as they are in the same tree."""
        found: dict[str, tuple[float, float, float]] = {}
        for frame in self._tf.frames:
            name, _, base = frame.rpartition("/")
            if not name or base not in BASES or name in found or f"/{name}" == self._namespace:
                continue
            try:
                pose = self._tf.get(self._frame, frame).planar
            except TransformError:
                continue
            found[name] = pose.x, pose.y, pose.yaw
            if len(found) == OTHERS_BOUND:
                break
        return found

    def close(self) -> None:
        """Stop listening."""
        for monitor in self._monitors.values():
            monitor.close()
        self._monitors.clear()
