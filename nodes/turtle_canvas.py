"""The drawing surface of turtles: strokes to show, and pixels for colour look-ups.

Strokes are the drawing as lines, few enough to send as one picture. Two rules limit their number: a stroke keeps only
the points where it bends, and when all strokes together have more than `MAX_POINTS` points, the oldest is dropped.
Pixels are the drawing in turtlesim's window, always 1 MB: they give the colour under a turtle, and nothing is dropped.

Positions are in metres, with the origin at the bottom left and y up; only pixels count from the top.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

PIXELS = 500
"""Width and height of turtlesim's window."""
SCALE = 45.0
"""Pixels per metre: a turtle's image is 45 pixels high and represents one metre."""
TOLERANCE = 0.002
"""Largest distance in metres between a stroke and the turtle's path: a tenth of a pixel."""
MAX_POINTS = 10_000
"""Most points in all strokes: less than half a megabyte, in memory and in the picture."""
STROKE_POINTS = 250
"""Most points in one stroke; a longer one continues in a new stroke, so that its start can be dropped separately."""

Position: TypeAlias = tuple[float, float]
Colour: TypeAlias = tuple[int, int, int]


@dataclass(frozen=True)
class Pen:
    """A colour, with components from 0 to 255, and a width in pixels."""

    colour: Colour = (0xB3, 0xB8, 0xFF)
    width: int = 3


class Stroke:
    """A line of one pen, with as few points as possible within `TOLERANCE` of the pen's path.

    The last point moves with the pen while the path from the previous point is straight, that is, while every position
    lies in a sleeve around the line, whose angle narrows as it gets longer.
    """

    def __init__(self, pen: Pen, start: Position, end: Position) -> None:
        self.pen = pen
        self.points = [start, end]
        self._aim()

    def extend(self, point: Position) -> None:
        """Extend the stroke from the last point to `point`."""
        if self._goes_straight_to(point):
            self.points[-1] = point
        else:
            self.points.append(point)
            self._aim()

    def _aim(self) -> None:
        (x, y), end = self.points[-2:]
        self._bearing = math.atan2(end[1] - y, end[0] - x)
        self._left, self._right, self._reach = -math.pi, math.pi, 0.0
        self._goes_straight_to(end)

    def _goes_straight_to(self, point: Position) -> bool:
        x, y = self.points[-2]
        dx, dy = point[0] - x, point[1] - y
        reach = math.hypot(dx, dy)
        if reach < self._reach:  # on its way back
            return False
        if reach > TOLERANCE:
            offset = math.remainder(math.atan2(dy, dx) - self._bearing, math.tau)
            if not self._left <= offset <= self._right:
                return False
            slack = math.asin(TOLERANCE / reach)
            self._left, self._right = max(self._left, offset - slack), min(self._right, offset + slack)
        self._reach = reach
        return True


class Canvas:
    """The drawing so far."""

    def __init__(self) -> None:
        self.strokes: deque[Stroke] = deque()
        """The strokes, oldest first."""
        self._points = 0
        self._current: dict[str, Stroke] = {}
        self._pixels = np.zeros((PIXELS, PIXELS), np.uint32)

    def draw(self, who: str, pen: Pen, start: Position, end: Position) -> None:
        """Draw a straight line. It continues the last stroke of `who` if possible."""
        self._paint(pen, start, end)
        stroke = self._current.get(who)
        if stroke and stroke.pen == pen and stroke.points[-1] == start and len(stroke.points) < STROKE_POINTS:
            before = len(stroke.points)
            stroke.extend(end)
            self._points += len(stroke.points) - before
        else:
            self._current[who] = stroke = Stroke(pen, start, end)
            self.strokes.append(stroke)
            self._points += len(stroke.points)
        while self._points > MAX_POINTS:
            self._forget(self.strokes.popleft())

    def _forget(self, stroke: Stroke) -> None:
        self._points -= len(stroke.points)
        self._current = {who: current for who, current in self._current.items() if current is not stroke}

    def colour_at(self, position: Position) -> Colour | None:
        """Return the colour drawn at a position; None where nothing is drawn."""
        column, row = (min(max(round(v), 0), PIXELS - 1) for v in to_pixel(position))
        value = int(self._pixels[row, column])
        return (value >> 16 & 255, value >> 8 & 255, value & 255) if value else None

    def _paint(self, pen: Pen, start: Position, end: Position) -> None:
        """Set the pixels within half a pen's width of the line."""
        (x0, y0), (x1, y1) = to_pixel(start), to_pixel(end)
        radius = pen.width / 2
        left, right = _span(min(x0, x1) - radius, max(x0, x1) + radius)
        top, bottom = _span(min(y0, y1) - radius, max(y0, y1) + radius)
        rows, columns = np.ogrid[top:bottom, left:right]
        dx, dy = x1 - x0, y1 - y0
        along = ((columns - x0) * dx + (rows - y0) * dy) / (dx * dx + dy * dy or 1.0)
        nearest = np.clip(along, 0.0, 1.0)
        near = np.hypot(columns - x0 - nearest * dx, rows - y0 - nearest * dy) <= radius
        red, green, blue = pen.colour
        self._pixels[top:bottom, left:right][near] = 255 << 24 | red << 16 | green << 8 | blue


def to_pixel(position: Position) -> Position:
    """Convert a position to window coordinates: pixels from the left, pixels from the top."""
    return position[0] * SCALE, PIXELS - 1 - position[1] * SCALE


def _span(low: float, high: float) -> tuple[int, int]:
    """Return the pixels in the window from `low` to `high`, as the bounds of a slice."""
    first, last = (min(max(v, 0), PIXELS) for v in (low, high + 1))
    return math.floor(first), math.ceil(last)
