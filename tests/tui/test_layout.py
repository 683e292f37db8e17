"""The windows of a console, and their two forms as data."""

from __future__ import annotations

import pytest
import yaml

from graphflow.console.section import console_section
from graphflow.introspect.drawing.layered import Rect
from graphflow.markup import source
from graphflow.tui.layout import Layout, to_section
from graphflow.tui.panes import Content
from tests.tui.stage import as_json

SIZE = (100, 30)


def drive() -> Layout:
    layout = Layout()
    layout.open("home", layout.make_pane(Content("nodes")))
    layout.open("why", layout.make_pane(Content("groups")))
    w = layout.windows[0]
    w.split(w.focused, layout.make_pane(Content("echo", "/pose")), "columns", Rect(0, 0, *SIZE))
    w.split(w.focused, layout.make_pane(Content("log", "", {"level": "warn"})), "rows", w.places(*SIZE)[w.focused])
    w.resize(w.focused, "left", 7, *SIZE)
    return layout


def shape(layout: Layout) -> object:
    return [
        (n, w.name, [(str(p.content), p.content.options) for p in w.panes()], list(w.places(*SIZE).values()))
        for n, w in layout.windows.items()
    ]


def test_what_is_kept_with_the_run_comes_back() -> None:
    """Windows, panes, sizes, focus and zoom are restored."""
    layout = drive()
    layout.select(1)
    layout.windows[0].zoomed = True
    back = Layout.from_json(as_json(layout.to_json()))
    assert shape(back) == shape(layout)
    assert back.current == 1
    assert back.windows[0].zoomed
    assert back.windows[0].numbers.index(back.windows[0].focused) == 2


def test_what_is_written_into_a_graph_file_reads_back() -> None:
    """The section is valid, and opens the same panes in the same proportions."""
    layout = drive()
    text = yaml.safe_dump({"console": to_section(layout)})
    wrong: list[object] = []
    section = console_section(source.read(text, "g.yaml"), lambda *problem: wrong.append(problem))
    assert wrong == []
    back = Layout.from_json(section)
    assert [str(p.content) for p in back.windows[0].panes()] == ["nodes", "echo /pose", "log"]
    before, after = (list(x.windows[0].places(*SIZE).values()) for x in (layout, back))
    assert all(
        abs(a.width - b.width) <= 1 and abs(a.height - b.height) <= 1 for a, b in zip(before, after, strict=True)
    )


@pytest.mark.parametrize(
    "data",
    [
        None,
        {},
        {"windows": []},
        {"windows": [{}]},
        {"windows": [{"root": {}}]},
        {"windows": 3},
        {"windows": [{"root": {"split": "rows", "of": 3}}]},
    ],
)
def test_what_is_no_layout_is_refused(data: object) -> None:
    """Malformed data, possibly of another version, is refused."""
    with pytest.raises(ValueError, match="not a layout"):
        Layout.from_json(data)


def test_numbers_of_windows() -> None:
    """A new window takes the lowest free number; closing goes back to the previous window; the last stays."""
    layout = drive()
    assert layout.open("", layout.make_pane(Content("top"))) == 2
    layout.select(2)
    layout.select(1)
    assert layout.close(1)
    assert layout.current == 2
    assert layout.open("x", layout.make_pane(Content("top"))) == 1
    assert layout.close(2)
    assert layout.close(1)
    assert not layout.close(0)
    assert layout.windows[0].name == "home"
