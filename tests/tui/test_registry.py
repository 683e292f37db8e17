"""Views by name: graphflow's own, and those of other packages."""

from __future__ import annotations

from importlib.metadata import EntryPoint

import pytest

from graphflow.console.views import PLUGINS, VIEWS, known_views
from graphflow.tui.registry import describe, view_class
from graphflow.tui.view import View


class Mine(View):
    """A view of another package."""

    NAME = "mine"
    DOC = "what I need"


@pytest.mark.parametrize("name", list(VIEWS))
def test_the_views_that_graph_files_know_are_there(name: str) -> None:
    """Each name in the table of views has a view of that name, with a description."""
    view = view_class(name)
    assert name == view.NAME
    assert describe(name) == view.DOC
    assert view.DOC[0].islower() or view.DOC[0] == "t"


@pytest.mark.parametrize(
    ("value", "doc"),
    [
        ("tests.tui.test_registry:Mine", "what I need"),
        ("tests.tui.test_registry:nothing", "cannot be loaded"),
        ("tests.tui.test_registry:pytest", "is no subclass"),
    ],
)
def test_views_of_other_packages(value: str, doc: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Views are found by entry point; one that does not load shows the reason in its pane."""
    entry = EntryPoint("mine", value, PLUGINS)
    monkeypatch.setattr("importlib.metadata.entry_points", lambda group: [entry])
    assert known_views()[-1] == "mine"
    assert doc in describe("mine")
