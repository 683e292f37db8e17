"""Draw a directed graph as boxes and arrows of characters, in layers from left to right.

Layers and their order are chosen as by Sugiyama, Tagawa and Toda: arrows that close a cycle are reversed, each node is
in a layer after all its predecessors, an arrow across several layers gets a dummy place in each, and each layer is
sorted by the mean position of its neighbours. All arrows of one source share one lane, so that they branch as late as
possible. Arrows that go back run below everything else. Lines are stored as sets of directions by cell, so that
crossing lines get the character that joins them.

Source: Sugiyama, Tagawa, Toda, "Methods for visual understanding of hierarchical system structures", 1981.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

NORTH, EAST, SOUTH, WEST = 1, 2, 4, 8
_LINES = " ╵╶└╷│┌├╴┘─┴┐┤┬┼"
"""Line characters, indexed by the set of directions that meet in them."""
SWEEPS = 6
"""Number of times that the layers are sorted, alternately by the previous and the next layer."""
GAP = 1
"""Empty rows between two boxes."""


class Rect(NamedTuple):
    """A rectangle of the screen, in cells."""

    x: int
    y: int
    width: int
    height: int

    @property
    def right(self) -> int:
        return self.x + self.width

    @property
    def bottom(self) -> int:
        return self.y + self.height

    def contains(self, x: int, y: int) -> bool:
        return self.x <= x < self.right and self.y <= y < self.bottom


class Box(NamedTuple):
    """A box to be drawn: its lines of text, and the shape of its corners."""

    lines: tuple[str, ...]
    is_round: bool = True

    @property
    def width(self) -> int:
        return max(map(len, self.lines)) + 4

    @property
    def height(self) -> int:
        return len(self.lines) + 2


class Cell(NamedTuple):
    """A character of the drawing, with the name of its box or the source of its arrow; empty for none."""

    text: str
    box: str = ""
    arrow: str = ""


@dataclass
class _Place:
    """A box in its layer, or the place where an arrow passes through a layer."""

    name: str
    layer: int
    height: int
    box: Box | None = None
    order: float = 0.0
    x: int = 0
    y: int = 0

    @property
    def row(self) -> int:
        """The row of its arrows."""
        return self.y + self.height // 2


@dataclass
class Drawing:
    """The drawn graph."""

    rows: list[list[Cell]]
    boxes: dict[str, Rect] = field(default_factory=dict)
    """The rectangle of each box."""


def draw(boxes: Mapping[str, Box], arrows: Iterable[tuple[str, str]]) -> Drawing:
    """Draw named boxes and the arrows between them."""
    return _Drawer(boxes, dict.fromkeys(arrows)).drawn()


class _Drawer:
    def __init__(self, boxes: Mapping[str, Box], arrows: Iterable[tuple[str, str]]) -> None:
        self._boxes = boxes
        edges = [(a, b) for a, b in arrows if a in boxes and b in boxes]
        self._back = _back_edges(list(boxes), edges)
        self._forward = [edge for edge in edges if edge not in self._back]
        self._places: dict[str, _Place] = {}
        self._layers: list[list[_Place]] = []
        self._links: dict[str, list[str]] = {}
        """The successors of each place, in the next layer."""
        self._source: dict[str, str] = {}
        """The source of the arrow that passes through a place."""
        self._lines: dict[tuple[int, int], int] = {}
        self._owner: dict[tuple[int, int], str] = {}
        self._tips: dict[tuple[int, int], str] = {}

    def drawn(self) -> Drawing:
        self._put_in_layers()
        self._put_in_order()
        lanes = [self._lanes(i) for i in range(len(self._layers))]
        self._place(lanes)
        for i, lane in enumerate(lanes):
            self._route(i, lane)
        self._route_back(lanes)
        return self._characters()

    # Positions.

    def _put_in_layers(self) -> None:
        layer = _layers(list(self._boxes), self._forward)
        for name, box in self._boxes.items():
            self._places[name] = _Place(name, layer[name], box.height, box)
        for a, b in self._forward:
            before = a
            for between in range(layer[a] + 1, layer[b]):
                # One passage per source and layer: its arrows branch as late as possible.
                passage = f"{a} \0{between}"
                if passage not in self._places:
                    self._places[passage] = _Place(passage, between, 1)
                    self._source[passage] = a
                self._link(before, passage)
                before = passage
            self._link(before, b)
        self._layers = [[] for _ in range(max((p.layer for p in self._places.values()), default=0) + 1)]
        for place in self._places.values():
            self._layers[place.layer].append(place)

    def _link(self, a: str, b: str) -> None:
        links = self._links.setdefault(a, [])
        if b not in links:
            links.append(b)

    def _put_in_order(self) -> None:
        above: dict[str, list[str]] = {}
        for a, targets in self._links.items():
            for b in targets:
                above.setdefault(b, []).append(a)
        for layer in self._layers:
            for i, place in enumerate(layer):
                place.order = i
        for sweep in range(SWEEPS):
            layers = self._layers if sweep % 2 == 0 else self._layers[::-1]
            near = above if sweep % 2 == 0 else self._links
            for layer in layers:
                for place in layer:
                    orders = [self._places[n].order for n in near.get(place.name, ())]
                    place.order = sum(orders) / len(orders) if orders else place.order
                layer.sort(key=lambda place: place.order)
                for i, place in enumerate(layer):
                    place.order = i

    def _lanes(self, i: int) -> dict[str, int]:
        """Assign lanes right of a layer to its places with outgoing arrows; lower places get nearer lanes."""
        backs = {a for a, _ in self._back if self._places[a].layer == i}
        leaving = [place.name for place in self._layers[i] if self._links.get(place.name) or place.name in backs]
        return {name: n for n, name in enumerate(reversed(leaving))}

    def _place(self, lanes: Sequence[Mapping[str, int]]) -> None:
        heights = [sum(p.height + GAP for p in layer) - GAP for layer in self._layers]
        tallest = max(heights, default=0)
        incoming = [0] * len(self._layers)
        for _, b in self._back:
            incoming[self._places[b].layer] = 1
        x = 0
        for i, layer in enumerate(self._layers):
            x += 3 if incoming[i] else 0
            width = max((p.box.width for p in layer if p.box is not None), default=1)
            y = (tallest - heights[i]) // 2
            for place in layer:
                place.x, place.y = x, y
                y += place.height + GAP
            x += width + len(lanes[i]) + 4

    # Lines.

    def _width(self, place: _Place) -> int:
        return place.box.width if place.box is not None else 1

    def _lane_x(self, i: int, lane: int) -> int:
        return max(p.x + self._width(p) for p in self._layers[i]) + 1 + lane

    def _route(self, i: int, lanes: Mapping[str, int]) -> None:
        for place in self._layers[i]:
            targets = [self._places[n] for n in self._links.get(place.name, ())]
            if not targets:
                continue
            owner = self._source.get(place.name, place.name)
            x = self._lane_x(i, lanes[place.name])
            begin = place.x + (self._width(place) if place.box is not None else 0)
            self._across(begin, x, place.row, owner)
            self._lines[begin, place.row] |= WEST  # joins the line to the box
            for target in targets:
                self._down(x, place.row, target.row, owner)
                end = target.x - (1 if target.box is not None else 0)
                self._across(x, end, target.row, owner)
                if target.box is not None:
                    self._tips[end, target.row] = "▶"
                    self._owner[end, target.row] = owner

    def _route_back(self, lanes: Sequence[Mapping[str, int]]) -> None:
        bottom = max((p.y + p.height for p in self._places.values()), default=0)
        for n, source in enumerate(dict.fromkeys(a for a, _ in self._back)):
            a = self._places[source]
            y = bottom + n
            x = self._lane_x(a.layer, lanes[a.layer][source])
            begin = a.x + self._width(a)
            self._across(begin, x, a.row, source)
            self._lines[begin, a.row] |= WEST
            self._down(x, a.row, y, source)
            for target in [b for s, b in self._back if s == source]:
                b = self._places[target]
                left = b.x - 2
                self._across(left, x, y, source)
                self._down(left, b.row, y, source)
                self._across(left, b.x - 1, b.row, source)
                self._tips[b.x - 1, b.row] = "▶"
                self._owner[b.x - 1, b.row] = source

    def _across(self, x0: int, x1: int, y: int, owner: str) -> None:
        self._line([(x, y) for x in range(min(x0, x1), max(x0, x1) + 1)], EAST, WEST, owner)

    def _down(self, x: int, y0: int, y1: int, owner: str) -> None:
        self._line([(x, y) for y in range(min(y0, y1), max(y0, y1) + 1)], SOUTH, NORTH, owner)

    def _line(self, cells: Sequence[tuple[int, int]], ahead: int, behind: int, owner: str) -> None:
        for i, cell in enumerate(cells):
            bits = (ahead if i < len(cells) - 1 else 0) | (behind if i else 0)
            self._lines[cell] = self._lines.get(cell, 0) | bits
            self._owner[cell] = owner

    # Characters.

    def _characters(self) -> Drawing:
        rects = {p.name: Rect(p.x, p.y, p.box.width, p.height) for p in self._places.values() if p.box is not None}
        cells = {at: Cell(_LINES[bits], "", self._owner[at]) for at, bits in self._lines.items()}
        cells |= {at: Cell(tip, "", self._owner[at]) for at, tip in self._tips.items()}
        for name, rect in rects.items():
            for dy, text in enumerate(_frame(self._boxes[name])):
                cells |= {(rect.x + dx, rect.y + dy): Cell(c, name) for dx, c in enumerate(text)}
        width = max((x for x, _ in cells), default=-1) + 1
        height = max((y for _, y in cells), default=-1) + 1
        nothing = Cell(" ")
        return Drawing([[cells.get((x, y), nothing) for x in range(width)] for y in range(height)], rects)


def _frame(box: Box) -> list[str]:
    corners = "╭╮╰╯" if box.is_round else "┌┐└┘"
    inner = box.width - 2
    top, bottom = (f"{corners[i]}{'─' * inner}{corners[i + 1]}" for i in (0, 2))
    return [top, *(f"│{line:^{inner}}│" for line in box.lines), bottom]


def _back_edges(names: Sequence[str], edges: Sequence[tuple[str, str]]) -> dict[tuple[str, str], None]:
    """Find the edges that close a cycle, by a depth-first search that starts at names without predecessors."""
    targets: dict[str, list[str]] = {}
    for a, b in edges:
        targets.setdefault(a, []).append(b)
    reached = {b for _, b in edges}
    starts = [n for n in names if n not in reached] + list(names)
    back: dict[tuple[str, str], None] = {}
    done: set[str] = set()
    for start in starts:
        # An explicit stack of nodes and next edges: a long chain of nodes would exceed Python's recursion limit.
        path: list[tuple[str, int]] = [(start, 0)] if start not in done else []
        open_ = {start}
        while path:
            name, i = path.pop()
            ahead = targets.get(name, [])
            if i == len(ahead):
                done.add(name)
                open_.discard(name)
                continue
            path.append((name, i + 1))
            if ahead[i] in open_:
                back[name, ahead[i]] = None
            elif ahead[i] not in done:
                open_.add(ahead[i])
                path.append((ahead[i], 0))
    return back


def _layers(names: Sequence[str], edges: Sequence[tuple[str, str]]) -> dict[str, int]:
    """Assign each name a layer after all its predecessors."""
    before: dict[str, list[str]] = {name: [] for name in names}
    after: dict[str, list[str]] = {name: [] for name in names}
    for a, b in edges:
        before[b].append(a)
        after[a].append(b)
    left = {name: len(before[name]) for name in names}
    ready = [name for name in names if not left[name]]
    layer = dict.fromkeys(names, 0)
    for name in ready:
        for b in after[name]:
            layer[b] = max(layer[b], layer[name] + 1)
            left[b] -= 1
            if not left[b]:
                ready.append(b)
    return layer
