"""Keys of other tools in a graph file."""

from __future__ import annotations

import pytest
from pydantic import BaseModel

from graphflow.graph.checks.foreign_keys import _CONTAINED, correction
from graphflow.graph.model import Arg, GraphFile, GroupBlock, IncludeBlock, NodeSpec, StepSpec, keys_of


@pytest.mark.parametrize(
    ("key", "model", "text"),
    [
        ("depends_on", NodeSpec, "it is called 'after' here"),
        ("environment", NodeSpec, "it is called 'env' here"),
        ("condition", NodeSpec, "it is called 'if' here"),
        ("ports", NodeSpec, _CONTAINED),
        ("services", GraphFile, "it is called 'nodes' here"),
        ("version", GraphFile, "leave it out"),
        ("service", StepSpec, "it is called 'call' here"),
        ("action", StepSpec, "it is called 'goal' here"),
        ("sleep", StepSpec, "it is called 'delay' here"),
        ("description", Arg, "it is called 'doc' here"),
        ("params", IncludeBlock, "a node of the file is changed by override: {NODE: {params: {rate: 5.0}}}"),
        ("ns", GroupBlock, "it is called 'namespace' here"),
        ("sleep", NodeSpec, ""),
        ("service", NodeSpec, ""),
    ],
)
def test_what_is_meant(key: str, model: type[BaseModel], text: str) -> None:
    """It depends on where the key stands; others have nothing."""
    assert correction(key, keys_of(model)) == text


@pytest.mark.parametrize("model", [Arg, GraphFile, GroupBlock, IncludeBlock, NodeSpec, StepSpec])
def test_keys_of_graph_files(model: type[BaseModel]) -> None:
    """What may stand there is never answered."""
    from graphflow.graph.checks.foreign_keys import _OF_COMPOSE, _OF_NODES

    known = keys_of(model)
    allowed = {"namespace"} if model is NodeSpec else set()
    assert {key for key in known if key in {**_OF_NODES, **_OF_COMPOSE} and correction(key, known)} <= allowed
