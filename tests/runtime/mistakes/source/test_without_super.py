"""Hooks that replace those of a parent."""

from __future__ import annotations

from graphflow import Node, timer
from graphflow.runtime.mistakes.source.shadowing import definition_of
from graphflow.runtime.mistakes.source.slips import slips
from graphflow.runtime.mistakes.source.without_super import without_super


class Base(Node):
    async def on_start(self) -> None:
        self.goal = 3

    @timer(1.0)
    def tick(self) -> None:
        self.log.info("%s", self.goal)


class Forgets(Base):
    async def on_start(self) -> None:
        self.log.info("child")


class Calls(Base):
    async def on_start(self) -> None:
        await super().on_start()


class SetsItself(Base):
    async def on_start(self) -> None:
        self.goal = 4


def test_a_hook_without_its_parents() -> None:
    """An attribute that the parent's handlers read is missing, unless the hook calls the parent's, or sets it."""
    found = {}
    for cls in (Forgets, Calls, SetsItself):
        source = definition_of(cls)
        assert source is not None
        found[cls] = [text for _, text in without_super(cls, source[0])]
    assert found[Calls] == found[SetsItself] == []
    [text] = found[Forgets]
    assert text.startswith("on_start replaces that of Base (test_without_super.py:")
    assert text.endswith("which sets self.goal; write await super().on_start() in its first line")


def test_it_is_told_with_its_place() -> None:
    """Beside the other slips of the class."""
    [text] = slips(Forgets)
    assert text.startswith(f"{__file__}:{Forgets.on_start.__code__.co_firstlineno}: on_start replaces that of Base")
