"""Opening the console: the supervisor's greeting determines windows, prefix and theme."""

from __future__ import annotations

import json
import logging
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from graphflow.supervisor.rundir import GraphRun
from graphflow.tui import main
from graphflow.tui.layout import Layout
from graphflow.tui.panes import Content

KEPT = {"windows": [{"name": "kept", "root": {"view": "top", "about": "", "options": {}, "size": 1}, "focused": 0}]}
SECTION = {
    "prefix": "ctrl+g",
    "theme": "graphflow-light",
    "windows": [{"name": "file", "root": {"view": "log", "about": "", "options": {}, "size": 0}}],
}


class Shown:
    """Replaces the console: records its arguments, and is left at once."""

    made: list[tuple[Any, Layout | None, str, str]] = []  # noqa: RUF012
    ways: list[str] = []  # noqa: RUF012

    def __init__(self, hub: Any, layout: Layout | None, prefix: str, theme: str, *, welcome: bool) -> None:
        self.made.append((hub, layout, prefix, theme))

    def run(self) -> str:
        return self.ways.pop(0)


@pytest.fixture(autouse=True)
def shown(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    Shown.made.clear()
    Shown.ways[:] = ["detach"]
    monkeypatch.setattr(main, "Console", Shown)
    monkeypatch.delenv("TMUX", raising=False)
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "0")
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", "")
    logger = logging.getLogger()
    before, logger.handlers[:] = list(logger.handlers), []
    yield
    for handler in logger.handlers:
        handler.close()
    logger.handlers[:] = before


def run_in(folder: Path, socket: str = "s") -> GraphRun:
    return GraphRun("id", "lab", 7, os.getpid(), 0.0, time.time(), "lab.yaml", socket, str(folder), f"tcp/{socket}", "")


def opened(hello: dict[str, Any], folder: Path, monkeypatch: pytest.MonkeyPatch, **options: Any) -> main.Left:
    monkeypatch.setattr(main, "_initial_state", lambda run: (hello, [{"node": "/a", "class": "x:Y"}]))
    return main.open_console(run_in(folder), 7, command=("x",), verbs=dict, **options)


@pytest.mark.parametrize(
    ("hello", "view"),
    [
        ({"layout": KEPT, "console": SECTION}, "top"),
        ({"layout": None, "console": SECTION}, "log"),
        ({"layout": {"windows": [{"root": {}}]}, "console": SECTION}, "log"),
        ({}, None),
    ],
    ids=["kept with the run", "of the file", "kept by another version", "usual"],
)
def test_which_windows(
    hello: dict[str, Any], view: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Windows saved with the run come first, then the graph file's, then the default."""
    opened(json.loads(json.dumps(hello)), tmp_path, monkeypatch)
    [(hub, layout, _, _)] = Shown.made
    assert list(hub.supervision.nodes) == ["/a"]
    if view is None:
        assert layout is None
    else:
        assert layout is not None
        assert [p.content for p in layout.window.panes()] == [Content(view)]


@pytest.mark.parametrize(
    ("env", "option", "section", "prefix"),
    [
        ({}, None, None, "ctrl+b"),
        ({"TMUX": "x"}, None, None, "ctrl+a"),
        ({"TMUX": "x"}, None, SECTION, "ctrl+g"),
        ({"GRAPHFLOW_PREFIX": "ctrl+t"}, None, SECTION, "ctrl+t"),
        ({"GRAPHFLOW_PREFIX": "ctrl+t"}, "ctrl+o", SECTION, "ctrl+o"),
    ],
)
def test_which_prefix(
    env: dict[str, str], option: str | None, section: Any, prefix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The prefix comes from command line, environment or file; inside tmux it is not tmux's own."""
    for name, value in env.items():
        monkeypatch.setenv(name, value)
    opened({"console": section}, tmp_path, monkeypatch, prefix=option)
    assert Shown.made[0][2] == prefix
    assert Shown.made[0][3] == ("graphflow-light" if section else "graphflow-dark")


def test_going_to_another_graph(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The console opens again on the other graph, and reports the end of that one."""
    Shown.ways[:] = ["switch other", "stop"]
    monkeypatch.setattr(main, "running", lambda: [run_in(tmp_path), run_in(tmp_path, "other")])
    tour = {"windows": [{"name": "tour", "root": {"view": "tour"}}]}
    left = opened({}, tmp_path, monkeypatch, layout=tour)
    assert [layout.window.name if layout else None for _, layout, *_ in Shown.made] == ["tour", None]
    assert os.environ["GRAPHFLOW_RENDEZVOUS"] == "tcp/other"
    assert [hub.supervision.run.socket for hub, *_ in Shown.made] == ["s", "other"]
    assert (left.how, left.run and left.run.socket) == ("stop", "other")


def test_without_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nodes of others have no supervisor, and nothing can be stopped."""
    left = main.open_console(None, 9, command=("x",), verbs=dict)
    assert Shown.made[0][0].supervision is None
    assert left.run is None
