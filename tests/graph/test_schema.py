"""The JSON Schema of graph files: what it takes and what it refuses."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import jsonschema
import pytest

from graphflow.graph.schema import graph_schema, schema_text
from graphflow.markup import source
from tests.cases import slow
from tests.conftest import PROJECT

VALIDATOR = jsonschema.Draft202012Validator(graph_schema())
FILES = sorted((PROJECT / "graphs").rglob("*.yaml"))


def faults(text: str) -> list[Any]:
    return [list(error.absolute_path) for error in VALIDATOR.iter_errors(source.read(text, "f.yaml").data)]


@slow
def test_it_is_a_schema() -> None:
    """By the rules of JSON Schema itself."""
    jsonschema.Draft202012Validator.check_schema(graph_schema())


def test_it_is_saved_beside_our_graphs() -> None:
    """For editors; `graphflow schema > graphs/graph.schema.json` writes it anew."""
    assert (PROJECT / "graphs" / "graph.schema.json").read_text() == schema_text()


@pytest.mark.parametrize("file", FILES, ids=lambda f: str(f.relative_to(PROJECT / "graphs")))
def test_editors_find_it(file: Path) -> None:
    """Each of our files says where it is in its first line."""
    before, _, path = file.read_text().partition("\n")[0].partition("$schema=")
    assert before == "# yaml-language-server: "
    assert (file.parent / path).resolve() == PROJECT / "graphs" / "graph.schema.json"


@pytest.mark.parametrize("file", FILES, ids=[str(f.relative_to(PROJECT / "graphs")) for f in FILES])
def test_our_own_files(file: Path) -> None:
    """All of them are as the schema says."""
    assert faults(file.read_text()) == []


@pytest.mark.parametrize(
    "text",
    [
        "nodes: {a: {class: x:Y, params: , restart: never, critical: $(var c)}, b: {template: t, after: {a: done}}}",
        "group: [{namespace: n, nodes: {a: {command: [ls, 3]}}, for: {var: i, in: 1..3, nodes: {}}}]",
        "include: [a.yaml, {file: b.yaml, args: {x: 1}, if: $(var y)}]\nstrategy: $(var s)",
        "steps: {s: {set: /a, params: {b: 1}, timeout: $(var t)}}\nargs: {t: {type: float, default: 3}}",
    ],
)
def test_what_it_takes(text: str) -> None:
    """Short forms, blocks, and substitutions where numbers or words are wanted."""
    assert faults(text) == []


@pytest.mark.parametrize(
    ("text", "path"),
    [
        ("nods: {}", []),
        ("nodes: {a: {clas: x:Y}}", ["nodes", "a"]),
        ("nodes: {a: {params of groups: {}}}", ["nodes", "a"]),
        ("nodes: {a: {restart: often}}", ["nodes", "a", "restart"]),
        ("group: {nodes: {a: {critical: maybe}}}", ["group"]),
        ("steps: {s: {timeout: soon}}", ["steps", "s", "timeout"]),
        ("strategy: all", ["strategy"]),
        ("for: {var: i}", ["for"]),
    ],
)
def test_what_it_refuses(text: str, path: list[str]) -> None:
    """An unknown key, a word that is none of those, a type, a key that is missing."""
    assert path in faults(text)
