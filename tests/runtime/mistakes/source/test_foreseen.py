"""Mistakes in the source that a running node reports by itself."""

from __future__ import annotations

import importlib.util
import itertools
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from graphflow import DeclarationError, Node
from graphflow.runtime.mistakes.source.foreseen import check_init, foreseen

HEAD = """\
import asyncio
from graphflow import Node, Publisher, subscription, task, timer
from graphflow.msgs.std_msgs.msg import String


class Robot(Node):
"""
_numbers = itertools.count()
Make = Callable[[str], type[Node]]


@pytest.fixture
def robot(tmp_path: Path) -> Make:
    """Makes the class `Robot` of a module with these lines in its body."""

    def made(body: str) -> type[Node]:
        name = f"foreseen_{next(_numbers)}"
        file = tmp_path / f"{name}.py"
        file.write_text(HEAD + "".join(f"    {line}\n" for line in body.splitlines()))
        spec = importlib.util.spec_from_file_location(name, file)
        assert spec is not None
        assert spec.loader is not None
        sys.modules[name] = module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module.Robot  # type: ignore[no-any-return]

    return made


START = """\
async def on_start(self):
    while self.pose is None:
        await self.clock.sleep(0.1)
"""
SETS = """\
@subscription(String, "pose")
async def on_pose(self, pose):
    self.pose = pose
"""
WAITS = (
    "on_start waits for self.pose, and on_pose, which sets it, runs when on_start has returned: move the wait into a "
)


def test_a_wait_for_a_handler(robot: Make) -> None:
    """Is found whether the attribute begins in the class or in `__init__`, and through a method of the handler's."""
    for before in ("pose = None\n", "def __init__(self):\n    super().__init__()\n    self.pose = None\n"):
        [text] = foreseen(robot(before + START + SETS))
        assert text.partition(": ")[2] == f"{WAITS}@task"
    through = SETS.replace("self.pose = pose", "self.keep(pose)") + "def keep(self, pose):\n    self.pose = pose\n"
    [text] = foreseen(robot("pose = None\n" + START + through))
    assert f"{WAITS}@task" in text
    [text] = foreseen(robot("pose = False\n" + START.replace("self.pose is None", "not self.pose") + SETS))
    assert f"{WAITS}@task" in text


@pytest.mark.parametrize(
    "body",
    [
        "pose = 1\n" + START + SETS,
        "pose = None\n" + START.replace("async def on_start", "@task\nasync def go") + SETS,
        "pose = None\n" + START.replace("    while", "    self.spawn(self.find)\n    while") + SETS,
        "pose = None\n" + START + "        if self.name:\n            break\n" + SETS,
        "pose = None\n" + START + "        self.pose = await self.ask()\n" + SETS,
        "pose = None\n" + START + SETS.replace('@subscription(String, "pose")\n', ""),
        "pose = None\nother = None\n"
        + START
        + SETS
        + "def on(self):\n    self.other = lambda: setattr(self, 'pose', 1)\n",
        "pose = None\n" + START,
    ],
)
def test_waits_that_something_may_end(robot: Make, body: str) -> None:
    """Are not reported: a task, a loop that does something, a method that others may call."""
    assert foreseen(robot(body)) == []


def test_a_declaration_in_init(robot: Make) -> None:
    """Is refused, with the way to declare it, and so is that of a parent; what is created there is not."""
    init = "def __init__(self):\n    super().__init__()\n    self.out = {}\n"
    wrong = robot(init.format("Publisher(String, 'out')"))
    way = "self.out is not a Publisher of the node; write out = Publisher\\(...\\) in the body of the class"
    for cls in (wrong, type("Child", (wrong,), {})):
        with pytest.raises(DeclarationError, match=way):
            check_init(cls)
    check_init(robot(init.format("self.create_publisher(String, 'out', 10)")))
    check_init(robot(init.format("dict()")))
    check_init(robot("out = Publisher(String, 'out')"))
    check_init(Node)


def test_a_callback_that_is_called_at_once(robot: Make) -> None:
    """Is found; one that is passed, or that returns a callback, is not."""
    body = "def __init__(self):\n    super().__init__()\n    self.create_timer(1.0, {})\ndef work(self):\n    {}\n"
    [text] = foreseen(robot(body.format("self.work()", "self.n = 1")))
    assert "create_timer(..., self.work()) calls work at once, and passes on its result, None; write self.work" in text
    assert foreseen(robot(body.format("self.work", "self.n = 1"))) == []
    assert foreseen(robot(body.format("self.work()", "return print"))) == []


def test_a_forgotten_await(robot: Make) -> None:
    """Is found with its file and line, also in a parent."""
    cls = robot("@timer(1.0)\nasync def tick(self):\n    self.clock.sleep(1.0)")
    [text] = foreseen(type("Child", (cls,), {}))
    assert text.startswith(f"{sys.modules[cls.__module__].__file__}:9: `self.clock.sleep(1.0)` does nothing, since")
