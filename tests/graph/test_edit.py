"""Changing a graph file: comments and order stay, the rest of the file is as it was."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import GraphFileError
from graphflow.graph.edit import node_paths, with_console, with_group, with_params
from graphflow.graph.resolve import load

TEXT = """\
# A lab.
args:
  who: {default: arm, doc: Whose.}   # changes names

nodes:
  /$(var who)/left:   # the left one
    class: nodes.talker:Talker
    params: {rate: 2.0, word: 'hi'}  # slowly
    concurrency: {all: [tick, reset], other: {handlers: [stop], limit: 2}}
  right: {class: nodes.talker:Talker, namespace: /leg}
"""
LEFT = ("nodes", "/$(var who)/left")
RIGHT = ("nodes", "right")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    made = tmp_path / "lab.yaml"
    made.write_text(TEXT)
    return made


def test_where_nodes_are(file: Path) -> None:
    """By the line of their key, whatever the key becomes."""
    plan = load(file, [])
    assert node_paths(plan, {"/arm/left", "/leg/right"}, Path()) == {"/arm/left": LEFT, "/leg/right": RIGHT}
    assert node_paths(plan, {"/other"}, Path()) == {}
    file.write_text("\n" + TEXT)
    with pytest.raises(GraphFileError, match="was the file changed"):
        node_paths(plan, {"/arm/left"}, Path())


def test_an_included_node_is_changed_under_override(file: Path, tmp_path: Path) -> None:
    """The included file may belong to others."""
    over = tmp_path / "over.yaml"
    over.write_text("include: lab.yaml\n")
    plan = load(over, [])
    [path] = node_paths(plan, {"/leg/right"}, Path()).values()
    assert path == ("override", "right")
    over.write_text(with_params(over.read_text(), path, {"rate": 9.0}))
    assert over.read_text() == "include: lab.yaml\noverride:\n  right:\n    params: {rate: 9.0}\n"
    right = next(n for n in load(over, []).nodes if n.name == "/leg/right")
    assert right.params["rate"].value == 9.0


def test_a_byte_order_mark(file: Path) -> None:
    """It hides no node, as it hides none from the reader."""
    file.write_text(f"\ufeff{TEXT}", encoding="utf-8")
    assert node_paths(load(file, []), {"/arm/left"}, Path()) == {"/arm/left": LEFT}


def test_nodes_of_blocks(tmp_path: Path) -> None:
    """Where a group, a loop, or an include with arguments has them, they are changed by hand; it is said where."""
    (tmp_path / "base.yaml").write_text("nodes: {/b: {class: x:Y}}\n")
    file = tmp_path / "g.yaml"
    file.write_text(
        "group:\n  nodes:\n    /a: {class: x:Y}\ninclude:\n  - {file: base.yaml}\nnodes:\n  /c: {class: x:Y}\n"
    )
    plan = load(file)
    assert node_paths(plan, {"/c"}, tmp_path) == {"/c": ("nodes", "/c")}
    with pytest.raises(
        GraphFileError, match=r"g.yaml:3:5: the node is written in a group or loop, where it is changed"
    ):
        node_paths(plan, {"/a"}, tmp_path)
    with pytest.raises(GraphFileError, match=r"/b comes from here, which .*g.yaml includes in a block"):
        node_paths(plan, {"/b"}, tmp_path)


def test_parameters() -> None:
    """Changed in place, added where they are missing."""
    changed = with_params(TEXT, LEFT, {"rate": 5.0, "list": [1, 2]})
    wanted = TEXT.replace("{rate: 2.0, word: 'hi'}", "{rate: 5.0, word: 'hi', list: [1, 2]}")
    assert changed == wanted.replace("  # slowly", " # slowly"), "a comment keeps its column while there is room"
    assert with_params(TEXT, RIGHT, {"rate": 1.0}) == TEXT.replace(
        "namespace: /leg}", "namespace: /leg, params: {rate: 1.0}}"
    )


def test_groups() -> None:
    """A handler leaves the group it was in."""
    changed = with_group(TEXT, LEFT, "own", ["reset"])
    assert "{all: [tick], other: {handlers: [stop], limit: 2}, own: [reset]}" in changed
    changed = with_group(changed, LEFT, "own", ["stop"])
    assert "{all: [tick], other: {handlers: [], limit: 2}, own: [reset, stop]}" in changed
    assert with_group(changed, LEFT, "own", ["stop"]) == changed
    changed = with_group(TEXT, LEFT, "other", ["tick"])
    assert "{all: [reset], other: {handlers: [stop, tick], limit: 2}}" in changed


def test_windows_of_the_console() -> None:
    """What else the section says is kept."""
    section = {"windows": [{"name": "a", "panes": {"rows": ["nodes", {"log": "/x"}]}}]}
    changed = with_console(TEXT + "console: {prefix: ctrl+a}\n", section)
    assert changed.startswith(TEXT)
    assert "prefix: ctrl+a" in changed
    assert "{rows: [nodes, {log: /x}]}" in changed


@pytest.mark.parametrize("text", ["", "- 1\n", "a: {"])
def test_what_is_no_graph_file(text: str) -> None:
    """It is not written over."""
    with pytest.raises(GraphFileError):
        with_params(text, LEFT, {})
