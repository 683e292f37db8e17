"""The subjects of the panes of a graph file: the nodes, topics and other names that they show, with their places."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from graphflow.console.views import VIEWS
from graphflow.errors import Place
from graphflow.markup import source
from graphflow.markup.source import Data, Source


class Subject(NamedTuple):
    """The subject of a pane."""

    kind: str
    """As in `ViewForm.about`: `topic`."""
    text: str
    place: Place


def subjects(src: Source) -> Iterator[Subject]:
    """Yield the subjects in the section `console:` of a file; what is malformed is skipped."""
    yield from _subjects(src, src.data.get("console") if isinstance(src.data, dict) else None, ("console",))


def _subjects(src: Source, data: Data, at: source.Path) -> Iterator[Subject]:
    if isinstance(data, list):
        for i, pane in enumerate(data):
            yield from _subjects(src, pane, (*at, i))
    for key, value in data.items() if isinstance(data, dict) else ():
        if isinstance(value, (dict, list)):
            yield from _subjects(src, value, (*at, key))
        elif isinstance(value, str) and value and key in VIEWS and VIEWS[key].about:
            yield Subject(VIEWS[key].about, value, src.place((*at, key)))
