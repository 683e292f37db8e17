"""Updates that are lost across an `await`."""

from __future__ import annotations

import ast
import importlib.util
import itertools
import sys
from pathlib import Path

import pytest

from graphflow.runtime.mistakes.source.lost_updates import lost_updates

ODOMETER = """\
from graphflow import Client, Group, Node, service, subscription, timer
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import Int64


class Odometer(Node):
    add = Client(AddTwoInts, "add")
    state = Group(1)
    many = Group(None)
    total = 0

    @timer(0.1)
    async def spend(self):
        self.total -= 1

    @subscription(Int64, "amount")
    async def heard(self, m):
        LINE
"""
CALL = "await self.add.call(AddTwoInts.Request(a={}, b=m.data))"
TOLD = (
    "self.total is set from a value that was read before the await in line {}, so that a change by spend (line 14) "
    "meanwhile is lost; read self.total after the await, or put both in one group: state = Group(1) in the class, "
    "group=state on both"
)
_numbers = itertools.count()


def _told(folder: Path, code: str) -> list[str]:
    name = f"lost_{next(_numbers)}"
    file = folder / f"{name}.py"
    file.write_text(code)
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None
    assert spec.loader is not None
    sys.modules[name] = space = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(space)
    module = ast.parse(code)
    (definition,) = (item for item in module.body if isinstance(item, ast.ClassDef))
    return [text for _, text in lost_updates(space.Odometer, space.Odometer, definition, module)]


def _code(*lines: str) -> str:
    return ODOMETER.replace("LINE", "\n        ".join(lines))


@pytest.mark.parametrize(
    ("lines", "awaited"),
    [
        ([f"r = {CALL.format('self.total')}", "self.total = r.sum"], 18),
        ([f"self.total = ({CALL.format('self.total')}).sum"], 18),
        ([f"self.total = self.total + ({CALL.format(1)}).sum"], 18),
        ([f"self.total += ({CALL.format(1)}).sum"], 18),
        (["total = self.total", "await self.clock.sleep(1.0)", "self.total = total + 1"], 19),
        (["total = self.total", "more = total + 1", "await self.clock.sleep(1.0)", "self.total = more"], 20),
        (["total = self.total", f"r = {CALL.format('total')}", "self.total = r.sum"], 19),
        (["for _ in range(3):", "    r = self.total", "    await self.clock.sleep(1.0)", "    self.total = r + 1"], 20),
    ],
)
def test_an_update_that_is_lost(tmp_path: Path, lines: list[str], awaited: int) -> None:
    """It is told with the `await`, and the handler whose change is lost."""
    assert _told(tmp_path, _code(*lines)) == [TOLD.format(awaited)]


LOSES = _code("total = self.total", "await self.clock.sleep(1.0)", "self.total = total + 1")
SPEND = "@timer(0.1)\n    async def spend(self):\n        self.total -= 1"


@pytest.mark.parametrize(
    "code",
    [
        _code("total = self.total", "self.total = total + 1", "await self.clock.sleep(1.0)"),
        _code("await self.clock.sleep(1.0)", "total = self.total", "self.total = total + 1"),
        _code(f"r = {CALL.format(1)}", "self.total += r.sum"),
        _code(f"self.total = ({CALL.format(1)}).sum + self.total"),
        _code(f"r = {CALL.format(1)}", "self.total = r.sum"),
        _code("total = self.total", "await self.clock.sleep(1.0)", "self.total = self.total + total"),
        _code("total = self.total", "await self.clock.sleep(1.0)", "total = 5", "self.total = total"),
        _code("total = self.total", "self.reset()", "await self.clock.sleep(1.0)", "self.total = total"),
        _code(
            "total = self.total",
            "await self.clock.sleep(1.0)",
            "if self.total != total: return",
            "self.total = total + 1",
        ),
        _code(
            "total = self.total", "await self.clock.sleep(1.0)", "if self.total == total:", "    self.total = total + 1"
        ),
        _code("self.spender.cancel()", "total = self.total", "await self.clock.sleep(1.0)", "self.total = total + 1"),
        _code(
            "async with self.lock:",
            "    total = self.total",
            "    await self.clock.sleep(1.0)",
            "    self.total = total + 1",
        ),
        LOSES.replace("(0.1)", "(0.1, group=state)").replace('"amount")', '"amount", group=state)'),
        LOSES.replace("state = Group(1)", "default_group = Group(1)"),
        LOSES.replace("self.total -= 1", "if self.add: return\n        self.total -= 1"),
        LOSES.replace("self.total -= 1", "if self.add:\n            self.total -= 1"),
        LOSES.replace("self.total -= 1", "self.total = 5"),
        LOSES.replace("self.total -= 1", "self.other -= 1"),
        LOSES.replace("total = 0", "total = []").replace("-= 1", "+= [1]").replace("total + 1", "total[1:]"),
        LOSES.replace("    @timer(0.1)\n", ""),
    ],
)
def test_updates_that_are_not_lost(tmp_path: Path, code: str) -> None:
    """Read after the await, looked at again, kept apart by a group or a lock, or without another that always adds."""
    assert _told(tmp_path, code) == []


@pytest.mark.parametrize(("group", "is_told"), [("many", True), ("state", False)])
def test_runs_of_one_handler(tmp_path: Path, group: str, is_told: bool) -> None:
    """In a group without a limit they lose each other's updates."""
    code = LOSES.replace(SPEND, "").replace('"amount")', f'"amount", group={group})')
    told = _told(tmp_path, code)
    assert [text.partition("so that ")[2].partition(";")[0] for text in told] == (
        ["a change by another run of heard meanwhile is lost"] * is_told
    )


def test_a_subclass_that_overrides_one(tmp_path: Path) -> None:
    """It has its parent's other handlers only."""
    code = LOSES + "\n\nclass Odometer(Odometer):\n    async def spend(self):\n        pass\n"
    name = f"lost_{next(_numbers)}"
    (tmp_path / f"{name}.py").write_text(code)
    spec = importlib.util.spec_from_file_location(name, tmp_path / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    sys.modules[name] = space = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(space)
    module = ast.parse(code)
    parent = next(item for item in module.body if isinstance(item, ast.ClassDef))
    child, owner = space.Odometer, space.Odometer.__mro__[1]
    assert list(lost_updates(child, owner, parent, module)) == []
    assert len([*lost_updates(owner, owner, parent, module)]) == 1
