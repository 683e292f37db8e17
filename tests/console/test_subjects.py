"""The subjects of panes."""

from __future__ import annotations

from graphflow.console.subjects import subjects
from graphflow.markup import source


def test_subjects() -> None:
    """Every name that a pane shows has its kind and its place, however deep its pane lies."""
    text = (
        "console:\n"
        "  windows:\n"
        "    - panes: {columns: [{rows: [nodes, {log: /a, level: warn}], size: 40}, {echo: /pose}]}\n"
        "    - {layout: tiled, panes: [groups, {turtle: }, {plot: /pose.x, seconds: 10}]}\n"
    )
    assert [(one.kind, one.text, str(one.place)) for one in subjects(source.read(text, "g.yaml"))] == [
        ("node or namespace", "/a", "g.yaml:3:46"),
        ("topic", "/pose", "g.yaml:3:83"),
        ("topic.field", "/pose.x", "g.yaml:4:58"),
    ]


def test_what_is_malformed() -> None:
    """It is skipped, as the section's reader reports it."""
    for text in (
        "a: 1",
        "console: 3",
        "console: {windows: {panes: [3, {echo: [1]}, {ech: /a}]}}",
        "console: [[nodes]]",
    ):
        assert not list(subjects(source.read(text, "g.yaml")))
