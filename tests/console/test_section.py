"""The `console:` section: its content, and every mistake with its place and a suggestion."""

from __future__ import annotations

import pytest

from graphflow.console.section import console_section
from graphflow.console.views import known_views
from graphflow.errors import Place
from graphflow.markup import source


def read(text: str) -> tuple[object, list[str]]:
    wrong: list[str] = []

    def complain(place: Place, message: str) -> None:
        wrong.append(f"{place.line}:{place.column}: {message}")

    return console_section(source.read(text, "g.yaml"), complain), wrong


def test_windows_and_panes() -> None:
    """Rows, columns, sizes and options are read; a plain list is arranged by a layout."""
    section, wrong = read(
        "console:\n"
        "  prefix: ctrl+a\n"
        "  windows:\n"
        "    - name: drive\n"
        "      panes: {columns: [{rows: [nodes, {log: /a, level: warn}], size: 40}, {echo: /pose}]}\n"
        "    - {layout: tiled, panes: [groups, {turtle: }]}\n"
    )
    assert wrong == []
    assert section == {
        "prefix": "ctrl+a",
        "theme": None,
        "windows": [
            {
                "name": "drive",
                "layout": None,
                "root": {
                    "split": "columns",
                    "size": 0.0,
                    "of": [
                        {
                            "split": "rows",
                            "size": 40.0,
                            "of": [
                                {"view": "nodes", "about": "", "options": {}, "size": 0.0},
                                {"view": "log", "about": "/a", "options": {"level": "warn"}, "size": 0.0},
                            ],
                        },
                        {"view": "echo", "about": "/pose", "options": {}, "size": 0.0},
                    ],
                },
            },
            {
                "name": "",
                "layout": "tiled",
                "root": {
                    "split": "columns",
                    "size": 0.0,
                    "of": [
                        {"view": "groups", "about": "", "options": {}, "size": 0.0},
                        {"view": "turtle", "about": "", "options": {}, "size": 0.0},
                    ],
                },
            },
        ],
    }


@pytest.mark.parametrize(
    ("section", "problem"),
    [
        ("3", "1:10: console: expected a mapping, for example console: {windows: [{panes: [nodes, log]}]}"),
        ("{prefx: 1}", "1:11: unknown key 'prefx'; did you mean 'prefix'?"),
        ("{prefix: b}", "1:19: prefix: expected ctrl and a letter, got 'b'"),
        ("{theme: dark}", "1:18: theme: expected one of graphflow-dark,"),
        ("{windows: nodes}", "1:20: windows: expected a list of windows"),
        ("{windows: [3]}", "1:21: a window: expected a mapping"),
        ("{windows: [{name: x}]}", "1:21: a window needs panes, for example panes: [nodes, log]"),
        ("{windows: [{panes: []}]}", "columns: expected a list of views"),
        ("{windows: [{panes: [turtel]}]}", "1:30: 'turtel' is not a view; did you mean 'turtle'?"),
        ("{windows: [{panes: [3]}]}", "1:30: expected a view, or rows or columns of views, got 3"),
        ("{windows: [{panes: [echo]}]}", "1:30: echo needs a topic: {echo: ...}"),
        ("{windows: [{panes: [{top: /a}]}]}", "top takes no argument; write top alone"),
        ("{windows: [{panes: [{log: /a, levl: info}]}]}", "1:40: log has no option 'levl'; did you mean 'level'?"),
        ("{windows: [{panes: [{log: /a, level: loud}]}]}", "1:47: level: expected one of debug, info,"),
        ("{windows: [{panes: [{log: /a, filter: '('}]}]}", "filter: not a regular expression"),
        ("{windows: [{panes: [{log: /a, size: 200}]}]}", "1:46: size: expected a share from 1 to 100, got 200"),
        ("{windows: [{layout: wide, panes: [nodes]}]}", "1:30: layout: expected one of even-horizontal,"),
        ("{windows: [{panes: {rows: [nodes], name: x}}]}", "'name' is not allowed beside rows; only size is"),
        ("{windows: [{panes: {rows: nodes}}]}", "rows: expected a list of views, got 'nodes'"),
    ],
)
def test_mistakes(section: str, problem: str) -> None:
    """Each mistake is reported."""
    _, wrong = read(f"console: {section}\n")
    assert len(wrong) == 1
    assert problem in wrong[0]


def test_no_section() -> None:
    """Without the section there is no result."""
    assert read("nodes: {}\n") == (None, [])
    assert "turtle" in known_views()
