"""The types of the control socket's messages."""

from __future__ import annotations

from typing import get_args, get_type_hints

from graphflow.supervisor.control.messages import GraphEvent, NodeRow, Reply
from graphflow.supervisor.processes.process import Process
from tests.supervisor.control.test_components import node


def test_a_tag_belongs_to_one_type() -> None:
    """A reader tells events and replies apart by their tag alone; `hello` and `error` are both."""
    kinds = {*get_args(GraphEvent), *get_args(Reply)}
    tags = [get_args(get_type_hints(kind)["event"])[0] for kind in kinds]
    assert len(tags) == len(set(tags))


def test_a_row_has_the_keys_of_its_type() -> None:
    """`ps` prints them."""
    (row,) = Process("/a", [node("/a")], "log").rows()
    assert row.keys() == get_type_hints(NodeRow).keys()
