"""The interface between a node and its parts."""

from __future__ import annotations

import inspect

import pytest

from graphflow import Node
from graphflow.deadlock.protocols import Subject
from graphflow.runtime.node_core import NodeCore, core_of
from graphflow.runtime.part import Host, Part
from graphflow.testing import Graph


def both(core: NodeCore) -> tuple[Host, Subject]:
    """A core as its parts and as the search see it; the type checker holds it to both."""
    return core, core


@pytest.mark.parametrize("view", [Host, Subject])
def test_a_nodes_core_is_what_others_take_it_for(view: type) -> None:
    """It has every member that they rely on, and its methods take the same arguments."""
    core = both(core_of(Node("n")))[0]
    members = {name: value for name, value in vars(view).items() if not name.startswith("_")}
    assert members

    for name, wanted in members.items():
        found = inspect.getattr_static(core, name)
        if inspect.isfunction(wanted):
            assert list(inspect.signature(found).parameters) == list(inspect.signature(wanted).parameters), name


class Piece(Part):
    """Writes down when it is opened and closed."""

    def __init__(self, name: str, story: list[str], *, opens_last: bool = False) -> None:
        self.name, self.story, self.opens_last = name, story, opens_last

    def open(self) -> None:
        self.story.append(f"{self.name} opens")

    def close(self) -> None:
        self.story.append(f"{self.name} closes")


async def test_parts_open_in_order_and_close_in_reverse(graph: Graph) -> None:
    """Late ones when on_start has returned, and of these those last that begin work by themselves."""
    story: list[str] = []

    class Prepares(Node):
        async def on_start(self) -> None:
            story.append("on_start")

    node = Prepares("n")
    core = core_of(node)
    core.add(Piece("timer", story, opens_last=True), late=True)
    core.add(Piece("service", story), late=True)
    core.add(Piece("publisher", story))
    await graph.start(node)
    core.add(Piece("another", story), late=True)
    assert story == ["publisher opens", "on_start", "service opens", "timer opens", "another opens"]

    story.clear()
    await graph.stop(node)
    assert story == ["another closes", "publisher closes", "service closes", "timer closes"]


async def test_a_part_that_was_forgotten_is_let_alone(graph: Graph) -> None:
    """One that was closed before the node runs is not opened, nor closed again."""
    story: list[str] = []
    node = Node("n")
    core = core_of(node)
    for late in (False, True):
        core.forget(core.add(Piece("gone", story), late=late))
    await graph.start(node)
    await graph.stop(node)

    assert story == []


def test_a_part_says_of_itself_what_it_has() -> None:
    """The defaults are no name, no endpoints, no counters and no handler."""
    piece = Piece("bare", [])

    assert (piece.title, piece.endpoints, piece.statistics(), piece.begin_to_stop()) == ("", (), {}, None)
    piece.clock_changed()
    assert piece.story == []
    with pytest.raises(TypeError, match="abstract"):
        Part()  # type: ignore[abstract]
