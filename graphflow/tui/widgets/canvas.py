"""Drawings in braille characters of two by four dots, and the drawings of turtles."""

from __future__ import annotations

import math
import re
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import NamedTuple

from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual.geometry import Region
from textual.strip import Strip
from textual.widget import Widget

from graphflow.tui.widgets.colours import Colours, colours_of

WORLD = 11.0889
"""Width and height of turtlesim's world in metres: 500 pixels less one, at 45 per metre."""
PIXELS, SCALE = 500, 45.0
PICTURE_BOUND = 4 << 20
"""Maximum characters of a picture."""
RECENT = 20_000
"""Moves remembered between two pictures."""
DEFAULT_PEN = (0xB3, 0xB8, 0xFF)
_STROKE = re.compile(r'<polyline points="([^"]{1,200000})" stroke="#([0-9a-fA-F]{6})" stroke-width="(\d{1,3})"')
_HEADS = "▶◥▲◤◀◣▼◢"
"""Triangles pointing east, north-east, north, ..."""
_DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
"""The bit of each dot of a braille cell, by row and column. Source: Unicode, U+2800."""

RGB = tuple[int, int, int]


class Dots:
    """A grid of dots; each cell of two by four has one colour."""

    def __init__(self, width: int, height: int) -> None:
        self.width, self.height = width, height
        self._bits = [bytearray(width) for _ in range(height)]
        self._colours: list[list[RGB | None]] = [[None] * width for _ in range(height)]
        self.changed: set[tuple[int, int]] = set()
        """Changed cells by column and row; emptied by the reader."""

    def line(self, x0: float, y0: float, x1: float, y1: float, colour: RGB) -> None:
        """Draw a line between two dots, counted from the top left."""
        steps = max(1, math.ceil(max(abs(x1 - x0), abs(y1 - y0))))
        for i in range(steps + 1):
            self.dot(round(x0 + (x1 - x0) * i / steps), round(y0 + (y1 - y0) * i / steps), colour)

    def dot(self, x: int, y: int, colour: RGB) -> None:
        """Set a dot, unless it is outside."""
        if 0 <= x < 2 * self.width and 0 <= y < 4 * self.height:
            column, row, bit = x >> 1, y >> 2, _DOTS[y & 3][x & 1]
            if not self._bits[row][column] & bit or self._colours[row][column] != colour:
                self._bits[row][column] |= bit
                self._colours[row][column] = colour
                self.changed.add((column, row))

    def row(self, y: int) -> list[tuple[str, RGB | None]]:
        """Return a row of cells as runs of text of one colour."""
        runs: list[tuple[str, RGB | None]] = []
        for bits, colour in zip(self._bits[y], self._colours[y], strict=True):
            text = chr(0x2800 + bits) if bits else " "
            if runs and runs[-1][1] == colour:
                runs[-1] = (runs[-1][0] + text, colour)
            else:
                runs.append((text, colour))
        return runs


class Line(NamedTuple):
    """A stroke: its colour, and its points in metres."""

    colour: RGB
    points: list[tuple[float, float]]


@dataclass
class Turtle:
    """A turtle: its position in metres, its heading in radians, and its pen."""

    x: float
    y: float
    theta: float
    colour: RGB = DEFAULT_PEN


class Move(NamedTuple):
    """A line drawn by a turtle between two poses."""

    at: float
    """The time by the monotonic clock."""
    colour: RGB
    x0: float
    y0: float
    x1: float
    y1: float


@dataclass
class Drawing:
    """The drawing of all turtles: the last picture from the simulator, and the moves since."""

    lines: list[Line] = field(default_factory=list)
    recent: deque[Move] = field(default_factory=lambda: deque(maxlen=RECENT))
    turtles: dict[str, Turtle] = field(default_factory=dict)
    pictures: int = 0
    """Number of pictures received."""
    moves: int = 0
    """Number of moves."""
    now: float = 0.0

    def moved(self, name: str, x: float, y: float, theta: float, jump: float) -> None:
        """Record a turtle's pose. It has drawn a line, unless it was teleported by `jump` metres or more."""
        if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(theta)):
            return
        turtle = self.turtles.get(name)
        if turtle is None:
            self.turtles[name] = Turtle(x, y, theta)
            return
        if (x, y) != (turtle.x, turtle.y):
            if math.hypot(x - turtle.x, y - turtle.y) < jump:
                self.recent.append(Move(self.now, turtle.colour, turtle.x, turtle.y, x, y))
            self.moves += 1
        turtle.x, turtle.y, turtle.theta = x, y, theta

    def take(self, lines: list[Line], asked: float) -> None:
        """Take a picture requested at some time. It includes all earlier moves."""
        self.lines = lines
        while self.recent and self.recent[0].at < asked:
            self.recent.popleft()
        for turtle in self.turtles.values():
            # A pose has no colour: the pen is that of the stroke which ends at the turtle.
            ends = ((math.hypot(s.points[-1][0] - turtle.x, s.points[-1][1] - turtle.y), s.colour) for s in lines)
            near = min(ends, default=(9.0, DEFAULT_PEN))
            if near[0] < 0.3:
                turtle.colour = near[1]
        self.pictures += 1


def read_picture(svg: str) -> list[Line]:
    """Parse the strokes in turtlesim's picture."""
    lines = []
    for points, colour, _ in _STROKE.findall(svg[:PICTURE_BOUND]):
        rgb = (int(colour[:2], 16), int(colour[2:4], 16), int(colour[4:], 16))
        pairs = [point.partition(",") for point in points.split()]
        try:
            metres = [((float(x) - 0.5) / SCALE, (PIXELS - 0.5 - float(y)) / SCALE) for x, _, y in pairs]
        except ValueError:
            continue
        if metres and all(math.isfinite(x) and math.isfinite(y) for x, y in metres):
            lines.append(Line(rgb, metres))
    return lines


LONGEST = 20
"""Maximum letters of a turtle's name."""


class Placed(NamedTuple):
    """The place of a turtle in cells."""

    column: int
    row: int
    head: str
    name_row: int

    def named(self, name: str) -> list[tuple[int, int]]:
        """The cells of the name, right of the head."""
        return [(self.column + 1 + i, self.name_row) for i in range(min(LONGEST, len(name)))]


class TurtleCanvas(Widget):
    """A drawing on the screen, as large as fits, with equal width and height."""

    def __init__(self, drawing: Drawing) -> None:
        super().__init__()
        self._drawing = drawing
        self._dots = Dots(0, 0)
        self._drawn: tuple[int, int, int] = (0, 0, -1)
        self._moves = 0
        self._placed: dict[str, Placed] = {}

    def redraw(self) -> None:
        """Draw the changes; everything if the size or the picture has changed."""
        drawing, (width, height) = self._drawing, self.size
        wanted = (width, height, drawing.pictures)
        is_new = wanted != self._drawn
        if is_new:
            self._drawn, self._dots = wanted, Dots(width, height)
            for line in drawing.lines:
                for (x0, y0), (x1, y1) in zip(line.points, line.points[1:], strict=False):
                    self._line(x0, y0, x1, y1, line.colour)
            fresh = list(drawing.recent)
        else:
            # `recent` is bounded: moves that it has dropped come with the next picture.
            count = min(drawing.moves - self._moves, len(drawing.recent))
            fresh = [drawing.recent[i] for i in range(-count, 0)]
        self._moves = drawing.moves
        for move in fresh:
            self._line(move.x0, move.y0, move.x1, move.y1, move.colour)
        placed = self._place()
        changed = self._dots.changed
        for name in placed.keys() | self._placed.keys():
            if placed.get(name) != self._placed.get(name):
                for at in (each[name] for each in (self._placed, placed) if name in each):
                    # The ends of a name are enough: a region spans everything between the cells of a row.
                    changed |= {(at.column, at.row), *(at.named(name)[:: max(1, min(LONGEST, len(name)) - 1)])}
        self._placed = placed
        if is_new:
            self.refresh()
        elif changed:
            self.refresh(*_regions(changed))
        changed.clear()

    def _place(self) -> dict[str, Placed]:
        """Return the cells of all turtles. A name is above its turtle, or below if another name is there."""
        placed: dict[str, Placed] = {}
        taken: set[tuple[int, int]] = set()
        for name, turtle in self._drawing.turtles.items():
            dot_x, dot_y = self._dot(turtle.x, turtle.y)
            column, row, head = int(dot_x) >> 1, int(dot_y) >> 2, _HEADS[round(turtle.theta / (math.pi / 4)) % 8]
            at = Placed(column, row, head, row - 1)
            if row == 0 or not taken.isdisjoint(at.named(name)):
                at = Placed(column, row, head, row + 1)
            taken.update(at.named(name))
            placed[name] = at
        return placed

    @property
    def _scale(self) -> float:
        """Dots per metre."""
        return max(1.0, min(2 * self._dots.width, 4 * self._dots.height) - 1) / WORLD

    def _dot(self, x: float, y: float) -> tuple[float, float]:
        scale = self._scale
        left = max(0.0, (2 * self._dots.width - WORLD * scale) / 2)
        top = max(0.0, (4 * self._dots.height - WORLD * scale) / 2)
        return left + x * scale, top + (WORLD - y) * scale

    def _line(self, x0: float, y0: float, x1: float, y1: float, colour: RGB) -> None:
        self._dots.line(*self._dot(x0, y0), *self._dot(x1, y1), colour)

    def render_line(self, y: int) -> Strip:
        base, colours = self.rich_style, self._colours
        if y >= self._dots.height:
            return Strip.blank(self.size.width, base)
        cells: list[tuple[str, Style]] = []
        for text, colour in self._dots.row(y):
            style = base + self._pen(colour) if colour is not None else base
            cells += [(c, style) for c in text]
        self._border(cells, y, base + colours.dim)
        # The turtles as of `redraw`, which computed the cells: they may have moved meanwhile.
        for i, (name, at) in enumerate(self._placed.items()):
            style = base + colours.nodes[(i + 1) % len(colours.nodes)] + Style(bold=True)
            if at.row == y and 0 <= at.column < len(cells):
                cells[at.column] = (at.head, style)
            if at.name_row == y and len(self._placed) > 1:
                for c, (column, _) in zip(name, at.named(name), strict=False):
                    if 0 <= column < len(cells):
                        cells[column] = (c, style)
        return Strip([Segment(text, style) for text, style in cells]).simplify()

    def _border(self, cells: list[tuple[str, Style]], y: int, style: Style) -> None:
        """Draw the edges of the world."""
        (left, top), (right, bottom) = self._dot(0.0, WORLD), self._dot(WORLD, 0.0)
        first, last = int(left) >> 1, min(len(cells) - 1, int(right) >> 1)
        if not int(top) >> 2 <= y <= int(bottom) >> 2:
            return
        for at in (first - 1, last + 1):
            if 0 <= at < len(cells) and cells[at][0] == " ":
                cells[at] = ("│", style)

    @property
    def _colours(self) -> Colours:
        return colours_of(self)

    def _pen(self, colour: RGB) -> Style:
        """Return a visible colour for a pen: darker on a light background."""
        if not self._colours.is_dark:
            colour = (int(colour[0] * 0.55), int(colour[1] * 0.55), int(colour[2] * 0.65))
        elif max(colour) < 90:
            colour = (colour[0] + 90, colour[1] + 90, colour[2] + 90)
        return Style(color=Color.from_rgb(*colour))


def _regions(cells: Iterable[tuple[int, int]]) -> list[Region]:
    """Return one region per row that has any of the cells."""
    rows: dict[int, list[int]] = {}
    for column, row in cells:
        rows.setdefault(row, []).append(column)
    return [Region(min(at), row, max(at) - min(at) + 1, 1) for row, at in rows.items()]
