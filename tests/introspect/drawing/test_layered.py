"""Boxes and arrows: in every drawing, boxes are apart and every arrow can be followed to its tip."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from graphflow.introspect.drawing.layered import Box, Drawing, draw
from tests.cases import cases, count, slow

N = 9
GRAPHS = st.lists(st.tuples(st.integers(0, N - 1), st.integers(0, N - 1)), max_size=20)
_WAYS = {"╵": "n", "╶": "e", "╷": "s", "╴": "w", "└": "ne", "│": "ns", "┌": "es", "├": "nes", "┘": "nw", "─": "ew"}
_WAYS |= {"┴": "new", "┐": "sw", "┤": "nsw", "┬": "esw", "┼": "nesw", "▶": "ew"}
_STEP = {"n": (0, -1, "s"), "s": (0, 1, "n"), "e": (1, 0, "w"), "w": (-1, 0, "e")}


def lines(drawing: Drawing) -> list[str]:
    return ["".join(cell.text for cell in row).rstrip() for row in drawing.rows]


def reached(drawing: Drawing, source: str) -> set[str]:
    """The boxes that one comes to by walking from a box along all lines."""
    rect = drawing.boxes[source]
    y = rect.y + rect.height // 2
    todo, seen, found = [(rect.right, y)], set[tuple[int, int]](), set[str]()
    while todo:
        x, y = todo.pop()
        if (x, y) in seen or not (0 <= y < len(drawing.rows) and 0 <= x < len(drawing.rows[y])):
            continue
        seen.add((x, y))
        cell = drawing.rows[y][x]
        if cell.box:
            continue
        if cell.text == "▶":
            found |= {name for name, r in drawing.boxes.items() if r.contains(x + 1, y)}
        for way in _WAYS.get(cell.text, ""):
            dx, dy, back = _STEP[way]
            nx, ny = x + dx, y + dy
            if 0 <= ny < len(drawing.rows) and 0 <= nx < len(drawing.rows[ny]):
                text = drawing.rows[ny][nx].text
                if back in _WAYS.get(text, ""):
                    todo.append((nx, ny))
    return found


@slow
@cases(count(few=40, full=150))
@given(GRAPHS)
def test_whatever_the_graph(pairs: list[tuple[int, int]]) -> None:
    """No two boxes share a cell, no line runs through a box, and all targets are reached."""
    boxes = {f"/n{i}": Box((f"/n{i}", "x" * i) if i % 3 else (f"/n{i}",), i % 2 == 0) for i in range(N)}
    arrows = [(f"/n{a}", f"/n{b}") for a, b in pairs]
    drawing = draw(boxes, arrows)
    rects = list(drawing.boxes.values())
    for i, a in enumerate(rects):
        for b in rects[i + 1 :]:
            apart = a.right <= b.x or b.right <= a.x or a.bottom <= b.y or b.bottom <= a.y
            assert apart
    for name, rect in drawing.boxes.items():
        for y in range(rect.y, rect.bottom):
            assert all(cell.box == name for cell in drawing.rows[y][rect.x : rect.right])
    for source, target in arrows:
        assert target in reached(drawing, source), "\n".join(lines(drawing))


def test_a_control_loop() -> None:
    """Arrows that go back run below; lines that meet are joined."""
    boxes = {name: Box((name,)) for name in ("sim", "pose", "pilot", "cmd")}
    arrows = [("sim", "pose"), ("pose", "pilot"), ("pilot", "cmd"), ("cmd", "sim")]
    assert lines(draw(boxes, arrows)) == [
        "   ╭─────╮     ╭──────╮     ╭───────╮     ╭─────╮",
        " ┌▶│ sim │────▶│ pose │────▶│ pilot │────▶│ cmd │─┐",
        " │ ╰─────╯     ╰──────╯     ╰───────╯     ╰─────╯ │",
        " └────────────────────────────────────────────────┘",
    ]


def test_nothing() -> None:
    """An empty graph is an empty drawing; a single box is drawn alone."""
    assert draw({}, []).rows == []
    assert lines(draw({"a": Box(("a",))}, [])) == ["╭───╮", "│ a │", "╰───╯"]
