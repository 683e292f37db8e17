"""Bodies of graph files and groups, to which conversion adds."""

from __future__ import annotations

from graphflow.errors import Place
from graphflow.launchfiles.bodies import add, extend, put
from graphflow.markup.tree import Item, located

HERE = Place("f.launch.py", 1, 1)


def plain(body: dict[str, Item]) -> object:
    return Item(body, HERE).plain()


def test_entries_of_a_section() -> None:
    """A second entry with the same key goes into a group of its own, and replaces nothing."""
    body: dict[str, Item] = {}
    for value in (1, 2):
        put(body, "nodes", "a", located(value, HERE))
    assert plain(body) == {"nodes": {"a": 1}, "group": {"nodes": {"a": 2}}}


def test_blocks() -> None:
    """One stands alone; several are a list."""
    body: dict[str, Item] = {}
    add(body, "include", located("a.yaml", HERE))
    assert plain(body) == {"include": "a.yaml"}
    for name in ("b.yaml", "c.yaml"):
        add(body, "include", located(name, HERE))
    assert plain(body) == {"include": ["a.yaml", "b.yaml", "c.yaml"]}


def test_one_body_into_another() -> None:
    """Sections are merged, and blocks are added one by one."""
    body: dict[str, Item] = {}
    add(body, "include", located("a.yaml", HERE))
    extend(body, "include", located(["b.yaml", "c.yaml"], HERE))
    extend(body, "steps", located({"log_1": {"log": "a"}}, HERE))
    assert plain(body) == {"include": ["a.yaml", "b.yaml", "c.yaml"], "steps": {"log_1": {"log": "a"}}}
