"""The command line as data."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from graphflow.cli.tree import verbs


def test_verbs_arguments_and_options() -> None:
    """The tree has the verbs, arguments and options that the console completes."""
    tree = verbs()
    assert {"up", "topic", "param", "restart"} <= set(tree)
    echo = tree["topic"]["commands"]["echo"]
    assert echo["arguments"] == ["TOPIC", "[TYPE]"]
    assert echo["options"]["--once"] is False
    assert echo["options"]["--field"] is True
    assert tree["groups"]["commands"]["move"]["arguments"] == ["NODE", "HANDLER...", "GROUP"]
    assert json.loads(json.dumps(tree)) == tree


LISTING = ("list", "nodes", "find", "packages", "package", "executables", "ls", "ps", "info", "types", "graph", "top")


def _all(tree: dict[str, Any], path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], dict[str, Any]]]:
    for name, described in tree.items():
        if "commands" in described:
            yield from _all(described["commands"], (*path, name))
        else:
            yield (*path, name), described


def test_what_lists_is_for_programs_too() -> None:
    """Every verb that lists has `--json`; `interface info` shows a text."""
    without = [path for path, found in _all(verbs()) if path[-1] in LISTING and "--json" not in found["options"]]
    assert without == [("interface", "info")]
