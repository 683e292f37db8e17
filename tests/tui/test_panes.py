"""Windows as data: panes never overlap and leave no gap."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graphflow.console.section import LAYOUTS
from graphflow.introspect.drawing.layered import Rect
from graphflow.tui.layout import Layout
from graphflow.tui.panes import MIN_HEIGHT, MIN_WIDTH, Content, Pane, Split, Window, drag
from tests.cases import cases, count, slow

SIZE = (120, 40)


def window() -> tuple[Layout, Window]:
    layout = Layout()
    layout.open("w", layout.make_pane(Content("nodes")))
    return layout, layout.window


def covered(w: Window, size: tuple[int, int]) -> None:
    """Check that every cell belongs to one pane or to the line beside one."""
    places = w.places(*size)
    cells: dict[tuple[int, int], int] = {}
    for number, r in places.items():
        for x in range(r.x, r.right):
            for y in range(r.y, r.bottom):
                assert (x, y) not in cells
                cells[x, y] = number
    bars = [d.place for d in w.dividers(*size) if d.split.axis == "columns"]
    lines = {(b.x, y) for b in bars for y in range(b.y, b.bottom)}
    everywhere = {(x, y) for x in range(size[0]) for y in range(size[1])}
    assert len(places) < len(w.numbers) or set(cells) | lines == everywhere
    assert not set(cells) & lines


OPERATIONS = st.lists(
    st.tuples(
        st.sampled_from(["columns", "rows", "close", "swap", "grow", "zoom", "focus", *LAYOUTS]), st.integers(0, 9)
    ),
    max_size=25,
)


@slow
@cases(count(few=40, full=150))
@given(OPERATIONS)
def test_whatever_is_done_the_panes_fill_the_window(operations: list[tuple[str, int]]) -> None:
    """After splits, closes, swaps, moved borders and layouts, all cells are used once, and one pane has the focus."""
    layout, w = window()
    for what, n in operations:
        number = w.numbers[n % len(w.numbers)]
        if what in ("columns", "rows"):
            room = w.places(*SIZE).get(number, Rect(0, 0, 0, 0))
            w.split(number, layout.make_pane(Content(f"v{n}")), what, room)  # type: ignore[arg-type]
        elif what == "close":
            w.close(number)
        elif what == "swap":
            w.swap(number, 1 if n % 2 else -1)
        elif what == "grow":
            w.resize(number, ("left", "right", "up", "down")[n % 4], 3, *SIZE)
        elif what == "zoom":
            w.zoomed = not w.zoomed
        elif what == "focus":
            found = w.neighbour(number, ("left", "right", "up", "down")[n % 4], *SIZE)
            w.focus(number if found is None else found)
        else:
            w.arrange(what)
        assert w.focused in w.numbers
        assert w.last_focused in w.numbers
        assert len(set(w.numbers)) == len(w.numbers)
        covered(w, SIZE)


def test_a_window_that_is_too_small_shows_the_focused_pane() -> None:
    """In too little room for two panes there is one, as large as possible."""
    layout, w = window()
    new = layout.make_pane(Content("log"))
    assert w.split(w.focused, new, "columns", Rect(0, 0, *SIZE))
    assert w.places(20, 8) == {new.number: (0, 0, 20, 8)}
    assert w.dividers(20, 8) == []


def test_a_pane_without_room_is_not_split() -> None:
    """A refused split changes nothing."""
    layout, w = window()
    small = Rect(0, 0, 2 * MIN_WIDTH, 2 * MIN_HEIGHT - 1)
    assert not w.split(w.focused, layout.make_pane(Content("log")), "columns", small)
    assert not w.split(w.focused, layout.make_pane(Content("log")), "rows", small)
    assert len(w.numbers) == 1


def test_splitting_again_halves_one_pane_only() -> None:
    """As in tmux, the other panes keep their size."""
    layout, w = window()
    a = w.focused
    w.split(a, layout.make_pane(Content("b")), "columns", Rect(0, 0, *SIZE))
    before = w.places(*SIZE)[a]
    b = w.focused
    w.split(b, layout.make_pane(Content("c")), "columns", w.places(*SIZE)[b])
    assert abs(w.places(*SIZE)[a].width - before.width) <= 1, "the new line takes its cell from somebody"
    assert isinstance(w.root, Split)
    assert len(w.root.of) == 3


def test_borders_are_dragged_as_far_as_there_is_room() -> None:
    """A pane keeps its minimum width."""
    layout, w = window()
    w.split(w.focused, layout.make_pane(Content("b")), "columns", Rect(0, 0, *SIZE))
    [bar] = w.dividers(*SIZE)
    assert drag(bar, 3)
    left, right = w.places(*SIZE).values()
    assert left.width == MIN_WIDTH
    assert right.right == SIZE[0]
    [bar] = w.dividers(*SIZE)
    assert not drag(bar, 3)


@pytest.mark.parametrize("layout_name", LAYOUTS)
@pytest.mark.parametrize("count", [1, 2, 3, 5, 8])
def test_named_layouts(layout_name: str, count: int) -> None:
    """Each layout places all panes in order; main layouts give the first the largest share."""
    panes = [Pane(i, Content("x")) for i in range(1, count + 1)]
    w = Window("w", panes[0] if count == 1 else Split("rows", list(panes)))
    w.arrange(layout_name)
    assert w.numbers == list(range(1, count + 1))
    covered(w, (200, 80))
    if layout_name.startswith("main") and count > 1:
        areas: list[Any] = [r.width * r.height for r in w.places(200, 80).values()]
        assert areas[0] == max(areas)
