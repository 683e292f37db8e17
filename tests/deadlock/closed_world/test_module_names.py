"""Values that a module holds beside the node's class: which methods change them, and when that cannot be said."""

from __future__ import annotations

import asyncio
import sys
from types import ModuleType
from typing import Any

import pytest

from graphflow.analysis.class_source import Unknown, source_of
from graphflow.deadlock.asyncio_frames import frames_of, waiter_of
from graphflow.deadlock.closed_world.module_names import changes
from graphflow.deadlock.closed_world.object_waits import setters
from graphflow.deadlock.closed_world.wakers import Setters
from graphflow.testing.clock import settle
from tests.deadlock.stage import Stage
from tests.written import Written

TEXT = """
import array
import asyncio

import numpy as np

OCCUPIED = np.zeros(3)
COUNTS = array.array("i", [0, 0])
NAMES = []
ready = False

def keep(thing): ...
{beside}

class N:
    async def on_go(self):
        while not {condition}:
            await asyncio.sleep(60)

    def on_arrive(self): {arrive}

    def on_leave(self): {leave}
"""


async def found(
    written: Written,
    condition: str,
    arrive: str,
    leave: str = "print(OCCUPIED, NAMES, ready)",
    beside: str = "",
) -> tuple[Setters | None, ModuleType]:
    """Who can end the wait of `on_go`, and the module in which it is written."""
    places = {"condition": condition, "arrive": arrive, "leave": leave, "beside": beside}
    text = TEXT
    for name, code in places.items():
        text = text.replace(f"{{{name}}}", code)
    module = written(text)
    node: Any = module.N()
    stage = Stage()
    actor = stage.actor(node)
    for name in ("on_go", "on_arrive", "on_leave"):
        stage.handler(actor, name)
    task = asyncio.create_task(node.on_go())
    await settle()
    return setters(frames_of(task), waiter_of(task), actor, is_bounded=False), module


@pytest.mark.parametrize(
    ("condition", "arrive", "what"),
    [
        ("OCCUPIED.any()", "OCCUPIED[0] = 1.0", "OCCUPIED"),
        ("np.any(OCCUPIED)", "OCCUPIED.fill(1.0)", "OCCUPIED"),
        ("COUNTS[0]", "COUNTS[0] += 1", "COUNTS"),
        ("NAMES", "NAMES.append('x')", "NAMES"),
        ("len(NAMES)", "NAMES[:] = ['x']", "NAMES"),
        ("ready", "\n        global ready\n        ready = True", "ready"),
    ],
)
async def test_who_changes_it(
    graphflow_runner: asyncio.Runner, written: Written, condition: str, arrive: str, what: str
) -> None:
    """Arrays, containers, and names that a method binds anew; who only looks does not count."""
    setter, _ = await found(written, condition, arrive)

    assert setter is not None
    assert (setter.what, set(setter.handlers)) == (what, {"on_arrive"})


async def test_names_of_a_functions_own(graphflow_runner: asyncio.Runner, written: Written) -> None:
    """An argument or a local name that is called the same is something else."""
    beside = "def clear(OCCUPIED): OCCUPIED[0] = 0\ndef local():\n    OCCUPIED = []\n    OCCUPIED.append(1)"
    setter, _ = await found(written, "OCCUPIED.any()", "OCCUPIED[0] = 1.0", beside=beside)

    assert setter is not None
    assert setter.handlers == {"on_arrive"}


@pytest.mark.parametrize(
    ("leave", "beside"),
    [
        ("keep(OCCUPIED)", ""),
        ("keep(OCCUPIED[1:])", ""),
        ("keep(lambda: OCCUPIED.fill(1))", ""),
        ("...", "def fill(): OCCUPIED[0] = 1"),
        ("...", "SAME = OCCUPIED"),
        ("keep(OCCUPIED.reshape(1))", ""),
        ("...", "OCCUPIED = np.frombuffer(bytearray(24))"),
    ],
)
async def test_what_others_may_change(
    graphflow_runner: asyncio.Runner, written: Written, leave: str, beside: str
) -> None:
    """What is given away, changed by a function of the module, or has a second name, is nobody's to tell."""
    setter, _ = await found(written, "OCCUPIED.any()", "OCCUPIED[0] = 1.0", leave, beside)

    assert setter is None


@pytest.mark.parametrize("name", ["OCCUPIED", ""])
async def test_what_another_module_knows(
    graphflow_runner: asyncio.Runner, written: Written, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    """The value, or the module itself: it may change it."""
    _, module = await found(written, "OCCUPIED.any()", "OCCUPIED[0] = 1.0")
    source = source_of(module.N())
    assert [use.method for use in changes("OCCUPIED", module.__name__, source)] == ["on_arrive"]

    other = ModuleType("another")
    vars(other)["theirs"] = getattr(module, name) if name else module
    monkeypatch.setitem(sys.modules, "another", other)
    with pytest.raises(Unknown):
        list(changes("OCCUPIED", module.__name__, source))


async def test_a_module_that_is_not_there(graphflow_runner: asyncio.Runner, written: Written) -> None:
    """Nothing is known of it."""
    _, module = await found(written, "OCCUPIED.any()", "OCCUPIED[0] = 1.0")

    with pytest.raises(Unknown):
        list(changes("OCCUPIED", "gone", source_of(module.N())))


async def test_other_nodes_of_the_module(graphflow_runner: asyncio.Runner, written: Written) -> None:
    """They may change it as well, so that the waiter's own handlers are not all that can end its wait."""
    setter, module = await found(written, "OCCUPIED.any()", "OCCUPIED[0] = 1.0")
    assert setter is not None
    stage = Stage()
    waiter, stranger = stage.actor(module.N()), stage.actor(object())
    assert not setter.is_shared(waiter, stage.nodes)
    assert not setter._replace(module="").is_shared(waiter, [waiter, stranger, stage.actor(module.N())])
    assert setter.is_shared(waiter, stage.nodes)
