"""A robot from above: its trail, what its scanner sees, and the obstacles seen so far, in braille dots."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field

from rich.color import Color
from rich.segment import Segment
from rich.style import Style
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
NEAREST, FARTHEST = 0.5, 200.0
"""Metres from the middle to the nearer edge, closest in and farthest out."""
SEEN, TRAIL, SCAN = (0x6A, 0x78, 0x88), (0x4F, 0xA3, 0xFF), (0xFF, 0x6B, 0x5E)
"""Colours of remembered obstacles, of the trail, and of the scan."""
_HEADS = "▶◥▲◤◀◣▼◢"


@dataclass
class RobotDrawing:
    """The places in the fixed frame, in metres.

    Attributes:
        pose: The robot: x, y, and its heading in radians; None before it is known.
        points: The points of the last scan.
        seen: The cells in which obstacles have been seen, the latest at the end.
        radius: Metres from the middle to the nearer edge.
        follows: Whether the robot stays in the middle.
        middle: The middle of the drawing.
    """

    pose: tuple[float, float, float] | None = None
    points: list[tuple[float, float]] = field(default_factory=list)
    seen: dict[tuple[int, int], None] = field(default_factory=dict)
    trail: deque[tuple[float, float]] = field(default_factory=lambda: deque(maxlen=TRAIL_BOUND))
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


class MapCanvas(Widget):
    """A drawing on the screen, the same in both directions, with north at the top."""

    def __init__(self, drawing: RobotDrawing) -> None:
        super().__init__()
        self._drawing = drawing
        self._dots = Dots(0, 0)
        self._robot: tuple[int, int, str] | None = None

    def redraw(self) -> None:
        """Draw everything."""
        drawing, dots = self._drawing, Dots(*self.size)
        for i, j in drawing.seen:
            dots.dot(*self._place((i + 0.5) * CELL, (j + 0.5) * CELL), SEEN)
        trail = [self._place(x, y) for x, y in drawing.trail]
        for (x0, y0), (x1, y1) in zip(trail, trail[1:], strict=False):
            dots.line(x0, y0, x1, y1, TRAIL)
        for x, y in drawing.points:
            dots.dot(*self._place(x, y), SCAN)
        self._robot = None
        if drawing.pose is not None:
            x, y, yaw = drawing.pose
            column, row = self._place(x, y)
            self._robot = column >> 1, row >> 2, _HEADS[round(yaw / (math.pi / 4)) % 8]
        self._dots = dots
        self.refresh()

    def _place(self, x: float, y: float) -> tuple[int, int]:
        """Return the dot of a place, from the top left."""
        width, height = 2 * self.size.width, 4 * self.size.height
        scale = min(width, height) / 2 / self._drawing.radius
        return round(width / 2 + (x - self._drawing.middle[0]) * scale), round(
            height / 2 - (y - self._drawing.middle[1]) * scale
        )

    def render_line(self, y: int) -> Strip:
        base = self.rich_style
        if y >= self._dots.height:
            return Strip.blank(self.size.width, base)
        cells: list[tuple[str, Style]] = []
        for text, colour in self._dots.row(y):
            style = base + self._visible(colour) if colour is not None else base
            cells += [(c, style) for c in text]
        if self._robot is not None and self._robot[1] == y and 0 <= self._robot[0] < len(cells):
            cells[self._robot[0]] = self._robot[2], base + colours_of(self).nodes[1] + Style(bold=True)
        return Strip([Segment(text, style) for text, style in cells]).simplify()

    def _visible(self, colour: RGB) -> Style:
        """Return a colour; a darker one on a light background."""
        if not colours_of(self).is_dark:
            colour = (int(colour[0] * 0.6), int(colour[1] * 0.6), int(colour[2] * 0.6))
        return Style(color=Color.from_rgb(*colour))
