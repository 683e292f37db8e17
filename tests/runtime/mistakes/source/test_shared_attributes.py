"""Lists of a class that two of its nodes change."""

from __future__ import annotations

import asyncio
import importlib.util
import itertools
import sys
from pathlib import Path

import pytest

from graphflow import Node
from graphflow.runtime.context import Context
from graphflow.runtime.mistakes.source.shared_attributes import shared_attributes
from graphflow.runtime.run import running
from graphflow.testing import Graph
from graphflow.testing.clock import ManualClock
from graphflow.transport.memory import Network

Caplog = pytest.LogCaptureFixture

TRAIL = """\
from collections import deque
from typing import ClassVar
from graphflow import Node, timer


class Trail(Node):
    points = []

    @timer(1.0)
    def tick(self):
        self.points.append(1)
"""
_numbers = itertools.count()


def _trail(folder: Path, code: str) -> type[Node]:
    name = f"shared_{next(_numbers)}"
    file = folder / f"{name}.py"
    file.write_text(code)
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None
    assert spec.loader is not None
    sys.modules[name] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    cls: type[Node] = module.Trail
    return cls


async def test_two_nodes_of_a_process(graphflow_runner: asyncio.Runner, caplog: Caplog, tmp_path: Path) -> None:
    """The second is told when it starts; a single one is not, nor one of another class."""
    context = Context(Network().session(asyncio.get_running_loop()), clock=ManualClock())
    cls, other = _trail(tmp_path, TRAIL), _trail(tmp_path, TRAIL)
    async with running(cls(name="first"), other(name="other"), context=context):
        assert caplog.messages == []
        async with running(cls(name="second"), context=context):
            (text,) = caplog.messages
    assert text.partition(".py:")[2] == (
        "7: `points = []` in the class is one list for all of its nodes, and /first in this process changes it, too; "
        "write self.points = [] in __init__"
    )


async def test_two_nodes_of_a_test(graph: Graph, caplog: Caplog, tmp_path: Path) -> None:
    """They are in processes of their own where they are deployed."""
    cls = _trail(tmp_path, TRAIL)
    await graph.start(cls(name="first"), cls(name="second"))
    assert caplog.messages == []


@pytest.mark.parametrize(
    ("code", "is_told"),
    [
        (TRAIL, True),
        (TRAIL.replace("[]", "deque(maxlen=5)"), True),
        (TRAIL.replace("points = []", "points: list[int] = []"), True),
        (TRAIL.replace("[]", "set()").replace("append", "add"), True),
        (TRAIL.replace("[]", "{}").replace(".append(1)", "[1] = 2"), False),
        (TRAIL.replace("points = []", "points: ClassVar[list[int]] = []"), False),
        (TRAIL.replace("[]", "[]  # shared by the turtles"), False),
        (TRAIL.replace("[]", '[]\n    """Points of all turtles."""'), False),
        (TRAIL.replace("points", "all_points"), False),
        (TRAIL.replace("append(1)", "append(self)"), False),
        (TRAIL.replace("self.points", "Trail.points"), False),
        (TRAIL + "        print(type(self).points)\n", False),
        (TRAIL.replace("self.points.append(1)", "print(self.points)"), False),
        (TRAIL + "\n    async def on_start(self):\n        self.points = []\n", False),
        (TRAIL + "\n    def __init__(self, **names):\n        vars(self)['points'] = []\n", False),
    ],
)
def test_lists_of_a_class(tmp_path: Path, code: str, is_told: bool) -> None:
    """Each node has its own if a method sets it; those that nodes share on purpose are not told."""
    cls = _trail(tmp_path, code)
    first, second = (object.__new__(cls) for _ in range(2))
    if "vars(self)" in code:
        vars(first)["points"] = []
    assert bool(shared_attributes(first, [("/other", second)])) == is_told
