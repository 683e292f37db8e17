"""A robot from above: its map, its trail, what its scanner sees, and where it is going, in braille dots."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.message import Message
from textual.strip import Strip
from textual.widget import Widget

from graphflow.tui.widgets.canvas import RGB, Dots
from graphflow.tui.widgets.colours import colours_of

CELL = 0.05
"""Metres of a cell in which obstacles are remembered."""
SEEN_BOUND, TRAIL_BOUND = 20_000, 5_000
"""Cells and points of the trail that are kept, at most."""
STEP = 0.02
"""Metres that the robot drives between two points of its trail."""
DENSEST = 4
"""Points per side of a wall's cell, at most."""
NEAREST, FARTHEST = 0.5, 200.0
"""Metres from the middle to the nearer edge, closest in and farthest out."""
SEEN, TRAIL, SCAN = (0x6A, 0x78, 0x88), (0x4F, 0xA3, 0xFF), (0xFF, 0x6B, 0x5E)
"""Colours of remembered obstacles, of the trail, and of the scan."""
WALL, PATH, FOOTPRINT = (0xC8, 0xD2, 0xDC), (0x7E, 0xE0, 0x8A), (0xF0, 0xB3, 0x5A)
"""Colours of the map's obstacles, of the planned path, and of the footprint."""
_HEADS = "▶◥▲◤◀◣▼◢"


@dataclass
class RobotDrawing:
    """The places in the fixed frame, in metres.

    Attributes:
        pose: The robot: x, y, and its heading in radians; None before it is known.
        points: The points of the last scan.
        seen: The cells in which obstacles have been seen, the latest at the end.
        walls: The centres of a map's occupied cells, of shape (n, 2); the scan's own memory is not drawn then.
        wall_size: The size of these cells in metres.
        path: The planned path.
        footprint: The corners of the robot's outline.
        goal: Where the robot is to go: x, y.
        others: Other robots by name.
        cursor: A place that is being chosen.
        radius: Metres from the middle to the nearer edge.
        follows: Whether the robot stays in the middle.
        middle: The middle of the drawing.
    """

    pose: tuple[float, float, float] | None = None
    points: list[tuple[float, float]] = field(default_factory=list)
    seen: dict[tuple[int, int], None] = field(default_factory=dict)
    trail: deque[tuple[float, float]] = field(default_factory=lambda: deque(maxlen=TRAIL_BOUND))
    walls: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 2)))
    wall_size: float = 0.05
    path: list[tuple[float, float]] = field(default_factory=list)
    footprint: list[tuple[float, float]] = field(default_factory=list)
    goal: tuple[float, float] | None = None
    others: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    cursor: tuple[float, float] | None = None
    radius: float = 3.0
    follows: bool = True
    middle: tuple[float, float] = (0.0, 0.0)

    def scanned(self, points: Iterable[tuple[float, float]]) -> None:
        """Take the points of a scan."""
        self.points = list(points)
        for x, y in self.points:
            cell = math.floor(x / CELL), math.floor(y / CELL)
            self.seen.pop(cell, None)
            self.seen[cell] = None
        while len(self.seen) > SEEN_BOUND:
            del self.seen[next(iter(self.seen))]

    def moved(self, x: float, y: float, yaw: float) -> None:
        """Take a pose of the robot."""
        self.pose = x, y, yaw
        if not self.trail or math.hypot(x - self.trail[-1][0], y - self.trail[-1][1]) > STEP:
            self.trail.append((x, y))
        if self.follows:
            self.middle = x, y

    def zoom(self, factor: float) -> None:
        """Show a larger or smaller part."""
        self.radius = min(FARTHEST, max(NEAREST, self.radius * factor))

    def clear(self) -> None:
        """Forget obstacles and trail."""
        self.points.clear()
        self.seen.clear()
        self.trail.clear()
        self.walls = np.zeros((0, 2))
        self.path.clear()
        self.footprint.clear()
        self.others.clear()
        self.goal = None


class MapCanvas(Widget):
    """A drawing on the screen, the same in both directions, with north at the top."""

    class Chosen(Message):
        """A place was clicked: x and y in metres."""

        def __init__(self, x: float, y: float) -> None:
            super().__init__()
            self.x, self.y = x, y

    def __init__(self, drawing: RobotDrawing) -> None:
        super().__init__()
        self._drawing = drawing
        self._dots = Dots(0, 0)
        self._marks: dict[tuple[int, int], tuple[str, Style]] = {}

    def redraw(self) -> None:
        """Draw everything."""
        drawing, dots = self._drawing, Dots(*self.size)
        if len(drawing.walls):
            for x, y in np.unique(self._places(self._filled()), axis=0).tolist():
                dots.dot(x, y, WALL)
        else:
            for i, j in drawing.seen:
                dots.dot(*self._place((i + 0.5) * CELL, (j + 0.5) * CELL), SEEN)
        self._line(dots, drawing.trail, TRAIL)
        self._line(dots, drawing.path, PATH)
        self._line(dots, [*drawing.footprint, *drawing.footprint[:1]], FOOTPRINT)
        for x, y in drawing.points:
            dots.dot(*self._place(x, y), SCAN)
        self._dots = dots
        self._mark()
        self.refresh()

    def _filled(self) -> NDArray[np.float64]:
        """Return points in the cells of walls, as close to each other as the dots on the screen."""
        drawing = self._drawing
        per_side = min(DENSEST, math.ceil(drawing.wall_size * self._scale))
        offsets = ((np.arange(per_side) + 0.5) / per_side - 0.5) * drawing.wall_size
        inside = np.stack(np.meshgrid(offsets, offsets), axis=-1).reshape(-1, 1, 2)
        return (drawing.walls + inside).reshape(-1, 2)

    def _line(self, dots: Dots, points: Iterable[tuple[float, float]], colour: RGB) -> None:
        places = [self._place(x, y) for x, y in points]
        for (x0, y0), (x1, y1) in zip(places, places[1:], strict=False):
            dots.line(x0, y0, x1, y1, colour)

    def _mark(self) -> None:
        """Place the characters that are drawn over the dots."""
        drawing, colours = self._drawing, colours_of(self)
        self._marks = {}
        bold = Style(bold=True)
        if drawing.goal is not None:
            self._put(*drawing.goal, "✚", colours.good + bold)
        for name, (x, y, yaw) in drawing.others.items():
            column, row = self._put(x, y, _head(yaw), colours.node(name) + bold)
            for at, letter in enumerate(name[:12]):
                self._marks.setdefault((column + 1 + at, row), (letter, colours.node(name)))
        if drawing.pose is not None:
            self._put(*drawing.pose[:2], _head(drawing.pose[2]), colours.nodes[1] + bold)
        if drawing.cursor is not None:
            self._put(*drawing.cursor, "╋", colours.warn + bold)

    def _put(self, x: float, y: float, mark: str, style: Style) -> tuple[int, int]:
        column, row = self._place(x, y)
        self._marks[column >> 1, row >> 2] = mark, style
        return column >> 1, row >> 2

    @property
    def _scale(self) -> float:
        """Dots per metre."""
        return min(2 * self.size.width, 4 * self.size.height) / 2 / self._drawing.radius

    def _places(self, points: NDArray[np.float64]) -> NDArray[np.int64]:
        """Return the dots of places of shape (n, 2), from the top left."""
        x, y = self._drawing.middle
        moved = (points - np.array([x, y])) * self._scale * np.array([1.0, -1.0])
        return np.asarray(np.round(moved + np.array([self.size.width, 2 * self.size.height])), dtype=np.int64)

    def _place(self, x: float, y: float) -> tuple[int, int]:
        """Return the dot of a place, from the top left."""
        scale = self._scale
        return round(self.size.width + (x - self._drawing.middle[0]) * scale), round(
            2 * self.size.height - (y - self._drawing.middle[1]) * scale
        )

    def on_click(self, event: events.Click) -> None:
        """Tell the view which place was clicked."""
        x = self._drawing.middle[0] + (2 * event.x + 1 - self.size.width) / self._scale
        y = self._drawing.middle[1] + (2 * self.size.height - 4 * event.y - 2) / self._scale
        self.post_message(self.Chosen(x, y))

    def render_line(self, y: int) -> Strip:
        base = self.rich_style
        if y >= self._dots.height:
            return Strip.blank(self.size.width, base)
        cells: list[tuple[str, Style]] = []
        for text, colour in self._dots.row(y):
            style = base + self._visible(colour) if colour is not None else base
            cells += [(c, style) for c in text]
        for (column, row), (mark, style) in self._marks.items():
            if row == y and 0 <= column < len(cells):
                cells[column] = mark, base + style
        return Strip([Segment(text, style) for text, style in cells]).simplify()

    def _visible(self, colour: RGB) -> Style:
        """Return a colour; a darker one on a light background."""
        if not colours_of(self).is_dark:
            colour = (int(colour[0] * 0.6), int(colour[1] * 0.6), int(colour[2] * 0.6))
        return Style(color=Color.from_rgb(*colour))


def _head(yaw: float) -> str:
    """Return a triangle that points along a heading."""
    return _HEADS[round(yaw / (math.pi / 4)) % 8]
