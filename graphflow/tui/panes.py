"""Windows and panes as data, placed in cells. Nothing here depends on a screen.

A window is a tree: its leaves are panes, its inner nodes split their space into rows or columns by shares. Between two
columns is a line of one cell; a row needs none, since every pane begins with its title.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

from graphflow.console.section import LAYOUTS
from graphflow.introspect.drawing.layered import Rect

MIN_WIDTH, MIN_HEIGHT = 12, 3
"""The smallest size of a pane in cells, its title included."""
MAX_PANES = 40
MAX_WINDOWS = 50
MAIN_SHARE = 60.0

Axis = Literal["rows", "columns"]
Direction = Literal["left", "right", "up", "down"]


@dataclass(frozen=True)
class Content:
    """The content of a pane: a view, its subject and its options."""

    view: str
    about: str = ""
    options: dict[str, Any] = field(default_factory=dict)

    def __str__(self) -> str:
        return f"{self.view} {self.about}".rstrip()


@dataclass
class Pane:
    """A leaf: one view."""

    number: int
    content: Content
    share: float = 1.0


@dataclass
class Split:
    """An inner node: panes side by side, or one above the other."""

    axis: Axis
    of: list[Pane | Split]
    share: float = 1.0


class Divider(NamedTuple):
    """A border that can be dragged, between two neighbours of a split."""

    split: Split
    before: int
    """The index of the neighbour before the border."""
    place: Rect
    room: int
    """Cells of the split along its axis, without the lines between its parts."""


class Window:
    """One window: a tree of panes, one of them focused."""

    def __init__(self, name: str, root: Pane | Split) -> None:
        self.name = name
        self.root = root
        self.zoomed = False
        self.layout = ""
        """The named layout chosen last."""
        first = next(self.panes()).number
        self.focused = first
        self.last_focused = first

    def panes(self) -> Iterator[Pane]:
        """Iterate over the panes from left to right and top to bottom, in the order of the tree."""
        return _leaves(self.root)

    @property
    def numbers(self) -> list[int]:
        return [pane.number for pane in self.panes()]

    def pane(self, number: int) -> Pane:
        return next(p for p in self.panes() if p.number == number)

    def focus(self, number: int) -> None:
        """Focus a pane, ending a zoom of another one."""
        if number != self.focused:
            self.last_focused, self.focused = self.focused, number
            self.zoomed = False

    # geometry

    def places(self, width: int, height: int) -> dict[int, Rect]:
        """Return the place of each visible pane. Panes that do not fit are left out, the focused one last."""
        if self.zoomed:
            return {self.focused: Rect(0, 0, width, height)}
        found = {p.number: r for p, r in _placed(self.root, Rect(0, 0, width, height))}
        if any(r.width < MIN_WIDTH or r.height < MIN_HEIGHT for r in found.values()):
            return {self.focused: Rect(0, 0, width, height)}
        return found

    def dividers(self, width: int, height: int) -> list[Divider]:
        """Return the borders between panes. The border of two rows is the title line of the lower one."""
        if len(self.places(width, height)) < len(self.numbers):
            return []
        return list(_dividers(self.root, Rect(0, 0, width, height)))

    # changes

    def split(self, number: int, new: Pane, axis: Axis, room: Rect) -> bool:
        """Split a pane in two, the new one after it; return whether there was room.

        Args:
            room: The place of the pane.
        """
        enough = room.width >= 2 * MIN_WIDTH + 1 if axis == "columns" else room.height >= 2 * MIN_HEIGHT
        if not enough or len(self.numbers) >= MAX_PANES:
            return False
        old, above = self.pane(number), self._above(number)
        if above is not None and above.axis == axis:
            at = above.of.index(old)
            old.share = new.share = old.share / 2
            above.of.insert(at + 1, new)
        else:
            inner = Split(axis, [old, new], old.share)
            self._replace(old, inner)
            old.share = new.share = 1.0
        self.zoomed = False
        self.focus(new.number)
        return True

    def close(self, number: int) -> bool:
        """Remove a pane; return False if it is the last."""
        above = self._above(number)
        if above is None:
            return False
        numbers = self.numbers
        pane = self.pane(number)
        at = above.of.index(pane)
        neighbour = above.of[at - 1 if at else 1]
        neighbour.share += pane.share
        above.of.remove(pane)
        if len(above.of) == 1:
            only = above.of[0]
            only.share = above.share
            self._replace(above, only)
            self._flatten(only)
        left = self.numbers
        if self.focused == number:
            back = self.last_focused if self.last_focused in left else left[max(0, numbers.index(number) - 1)]
            self.focused = back
        if self.last_focused not in left:
            self.last_focused = self.focused
        self.zoomed = False
        return True

    def _flatten(self, node: Pane | Split) -> None:
        """Merge splits nested in a split of the same axis."""
        if isinstance(node, Pane):
            return
        above = self._split_above(node)
        if above is None or above.axis != node.axis:
            return
        total = sum(n.share for n in node.of) or 1.0
        for inner in node.of:
            inner.share *= node.share / total
        at = above.of.index(node)
        above.of[at : at + 1] = node.of

    def swap(self, number: int, step: int) -> None:
        """Swap a pane with the one before or after it."""
        panes = list(self.panes())
        at = next(i for i, p in enumerate(panes) if p.number == number)
        other = panes[(at + step) % len(panes)]
        pane = panes[at]
        pane.number, other.number = other.number, pane.number
        pane.content, other.content = other.content, pane.content

    def neighbour(self, number: int, direction: Direction, width: int, height: int) -> int | None:
        """Return the pane adjacent to the middle of a pane's side; at the edge of the window, wrap around."""
        places = {p.number: r for p, r in _placed(self.root, Rect(0, 0, width, height))}
        me = places[number]
        best: tuple[int, int, int] | None = None
        for other, r in places.items():
            if other == number:
                continue
            if direction in ("left", "right"):
                ahead = me.x - r.right if direction == "left" else r.x - me.right
                apart = max(r.y - me.bottom + 1, me.y - r.bottom + 1, 0)
                middle = abs((2 * r.y + r.height) - (2 * me.y + me.height))
            else:
                ahead = me.y - r.bottom if direction == "up" else r.y - me.bottom
                apart = max(r.x - me.right + 1, me.x - r.right + 1, 0)
                middle = abs((2 * r.x + r.width) - (2 * me.x + me.width))
            if apart:
                continue
            # Panes behind count as far ahead: moving past the edge wraps around to the other side.
            rank = (ahead if ahead >= 0 else 10_000 + ahead, middle, other)
            best = rank if best is None or rank < best else best
        return None if best is None else best[2]

    def next_pane(self, number: int, step: int = 1) -> int:
        numbers = self.numbers
        return numbers[(numbers.index(number) + step) % len(numbers)]

    def resize(self, number: int, direction: Direction, cells: int, width: int, height: int) -> bool:
        """Move a border of a pane, the far one if there is one; return whether it moved."""
        axis: Axis = "columns" if direction in ("left", "right") else "rows"
        step = cells if direction in ("right", "down") else -cells
        node: Pane | Split = self.pane(number)
        while (above := self._split_above(node)) is not None and above.axis != axis:
            node = above
        if above is None:
            return False
        at = above.of.index(node)
        index = at if at < len(above.of) - 1 else at - 1
        found = next((d for d in self.dividers(width, height) if d.split is above and d.before == index), None)
        if found is None:
            return False
        place = found.place.x if axis == "columns" else found.place.y
        return drag(found, place + step)

    def arrange(self, layout: str) -> None:
        """Arrange the panes in one of the five named layouts."""
        panes = list(self.panes())
        for pane in panes:
            pane.share = 1.0
        self.layout, self.zoomed = layout, False
        self.root = _arranged(panes, layout)

    def next_layout(self) -> str:
        """Change to the next named layout; return its name."""
        at = LAYOUTS.index(self.layout) + 1 if self.layout in LAYOUTS else 0
        self.arrange(LAYOUTS[at % len(LAYOUTS)])
        return self.layout

    def _above(self, number: int) -> Split | None:
        return self._split_above(self.pane(number))

    def _split_above(self, node: Pane | Split) -> Split | None:
        return next((s for s in _splits(self.root) if any(n is node for n in s.of)), None)

    def _replace(self, old: Pane | Split, new: Pane | Split) -> None:
        above = self._split_above(old)
        if above is None:
            self.root = new
        else:
            above.of[next(i for i, n in enumerate(above.of) if n is old)] = new


def drag(divider: Divider, to: int) -> bool:
    """Move a border to a column or row; return whether it moved."""
    split, i = divider.split, divider.before
    sizes = _sizes([n.share for n in split.of], divider.room)
    at = divider.place.x if split.axis == "columns" else divider.place.y
    least = MIN_WIDTH if split.axis == "columns" else MIN_HEIGHT
    before, after = sizes[i], sizes[i + 1]
    step = max(least - before, min(to - at, after - least))
    if step == 0 or before + step < least or after - step < least:
        return False
    sizes[i], sizes[i + 1] = before + step, after - step
    for node, size in zip(split.of, sizes, strict=True):
        node.share = float(size)
    return True


def _leaves(node: Pane | Split) -> Iterator[Pane]:
    if isinstance(node, Pane):
        yield node
    else:
        for inner in node.of:
            yield from _leaves(inner)


def _splits(node: Pane | Split) -> Iterator[Split]:
    if isinstance(node, Split):
        yield node
        for inner in node.of:
            yield from _splits(inner)


def _sizes(shares: list[float], room: int) -> list[int]:
    """Divide `room` into whole cells in proportion to the shares."""
    total = sum(shares) or 1.0
    # Edges are rounded and not sizes, which therefore add up to the room.
    edges = [round(room * part / total) for part in itertools.accumulate(shares, initial=0.0)]
    return [b - a for a, b in itertools.pairwise(edges)]


def _parts(split: Split, place: Rect) -> list[Rect]:
    if split.axis == "columns":
        sizes = _sizes([n.share for n in split.of], place.width - len(split.of) + 1)
        starts = itertools.accumulate([size + 1 for size in sizes], initial=place.x)  # one more than there are parts
        return [Rect(x, place.y, size, place.height) for x, size in zip(starts, sizes, strict=False)]
    sizes = _sizes([n.share for n in split.of], place.height)
    starts = itertools.accumulate(sizes, initial=place.y)
    return [Rect(place.x, y, place.width, size) for y, size in zip(starts, sizes, strict=False)]


def _placed(node: Pane | Split, place: Rect) -> Iterator[tuple[Pane, Rect]]:
    if isinstance(node, Pane):
        yield node, place
    else:
        for inner, part in zip(node.of, _parts(node, place), strict=True):
            yield from _placed(inner, part)


def _dividers(node: Pane | Split, place: Rect) -> Iterator[Divider]:
    if isinstance(node, Pane):
        return
    parts = _parts(node, place)
    is_columns = node.axis == "columns"
    room = place.width - len(node.of) + 1 if is_columns else place.height
    for i, part in enumerate(parts[:-1]):
        if is_columns:
            yield Divider(node, i, Rect(part.right, place.y, 1, place.height), room)
        else:
            yield Divider(node, i, Rect(place.x, part.bottom, place.width, 1), room)
    for inner, part in zip(node.of, parts, strict=True):
        yield from _dividers(inner, part)


def _arranged(panes: list[Pane], layout: str) -> Pane | Split:
    if len(panes) == 1:
        return panes[0]
    if layout in ("even-horizontal", "even-vertical"):
        return Split("columns" if layout == "even-horizontal" else "rows", list(panes))
    if layout in ("main-horizontal", "main-vertical"):
        main, *rest = panes
        outer: Axis = "rows" if layout == "main-horizontal" else "columns"
        inner: Axis = "columns" if layout == "main-horizontal" else "rows"
        others = rest[0] if len(rest) == 1 else Split(inner, list(rest))
        main.share, others.share = MAIN_SHARE, 100.0 - MAIN_SHARE
        return Split(outer, [main, others])
    columns = 1
    while columns * columns < len(panes):
        columns += 1
    rows: list[Pane | Split] = []
    for i in range(0, len(panes), columns):
        row = panes[i : i + columns]
        rows.append(row[0] if len(row) == 1 else Split("columns", list(row)))
    return rows[0] if len(rows) == 1 else Split("rows", rows)
