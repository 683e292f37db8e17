"""On which attributes a loop depends that only waits and looks again: short loops, and what is read of each."""

from __future__ import annotations

import ast
import asyncio
import textwrap
from typing import Any

import pytest

from graphflow.analysis.class_source import Unknown, source_of
from graphflow.deadlock.closed_world.conditions import LoopConditions, makes_task
from graphflow.executor.ledger import PendingGoal
from tests.written import Written

TEXT = """
import asyncio
import math
import queue
import random
import threading
import time
from collections import deque
from enum import Enum
from math import hypot

import numpy as np

from graphflow.msgs.turtlesim.msg import Pose
from tests.deadlock.closed_world.test_conditions import Goal

LIMIT = 3
moving = 3
LIST = []

class State(Enum):
    DRIVING = 1
    THERE = 2

def outside():
    global moving
    moving = 4

def own_function(a): return time.time() < a

async def pause():
    await asyncio.get_running_loop().create_future()

class Navigator:
    has_arrived = False

    def __init__(self):
        self.pose = Pose()
        self.legs = [1.0]
        self.lifted = threading.Event()
        self.next = self

    @property
    def nearly(self): return self.is_near(LIMIT)
    def is_near(self, distance): return abs(self.pose.x) < distance
    def is_done(self): return self.has_arrived
    def draws(self): return random.random() > 0.5

class N:
    there = False
    level: int = 3

    def __init__(self):
        self.pose = Pose()
        self.state = State.DRIVING
        self.many = [1, 2]
        self.table = dict(phase="driving")
        self.array = np.zeros(3)
        self.objects = np.array([object()])
        self.odd = [object()]
        self.arrived = asyncio.Event()
        self.words = asyncio.Queue()
        self.lifted = threading.Event()
        self.thing = object()
        self.nav = Navigator()
        self.goal = Goal()
        self.task = asyncio.get_running_loop().create_task(pause())

    @property
    def is_there(self): return self.there
    @property
    def clock_says(self): return time.time()
    def distance(self, x, y=0.0):
        dx = self.pose.x - x
        return math.hypot(dx, self.pose.y - y)
    def is_near(self, goal): return abs(self.pose.x - goal.x) > 0.1
    def branches(self):
        if self.there:
            return True
        return self.level > 2
    def binds_its_argument(self, x):
        x = self.level
        return x
    def draws(self): return random.random() > 0.5
    def counts(self):
        self.level += 1
        return self.level > 9
    def loops(self):
        if self.level > 9:
            return self.loops()
        return False
    async def asks(self): return self.there

    async def go(self, message=3, end=None):
{body}
        await pause()
"""


class Goal(PendingGoal):
    """A goal that has not ended."""

    def __init__(self) -> None:
        self.ended = asyncio.get_running_loop().create_future()

    @property
    def done(self) -> bool:
        return self.ended.done()

    def cancel(self) -> None:
        """Nobody does."""


async def read(written: Written, body: str) -> tuple[set[str], int]:
    """The attributes on which the first loop of a method depends, and the number of tasks that may end it."""
    module = written(TEXT.replace("{body}", textwrap.indent(textwrap.dedent(body).strip("\n"), " " * 8)))
    node: Any = module.N()
    coroutine = node.go()
    coroutine.send(None)
    frame, source = coroutine.cr_frame, source_of(node)
    function = source.function(frame.f_code)
    assert function is not None
    loop = next(n for n in ast.walk(function.syntax) if isinstance(n, (ast.While, ast.For, ast.AsyncFor)))
    conditions = LoopConditions(loop, function.syntax, frame, source, node)
    try:
        found = conditions.attributes()
        parts = {f"{owner}.{name}" for owner, names in conditions.owned.items() for name in names}
        return found | parts, len(conditions.tasks)
    finally:
        coroutine.close()


def polls(condition: str) -> str:
    return f"while not ({condition}):\n    await pause()"


@pytest.mark.parametrize(
    ("condition", "attributes"),
    [
        ("self.there", {"there"}),
        ("self.there or self.level > 3", {"there", "level"}),
        ("self.level + 1 < LIMIT", {"level"}),
        ("-self.level in (1, 2, LIMIT)", {"level"}),
        ("self.state is State.THERE", {"state"}),
        ("self.pose.x > 5.0", {"pose"}),
        ("math.hypot(self.pose.x, self.pose.y) > 5.0", {"pose"}),
        ("hypot(self.pose.x, self.pose.y) > 5.0", {"pose"}),
        ("np.linalg.norm(self.array) > 5.0", {"array"}),
        ("self.array[1:].any()", {"array"}),
        ("self.table['phase'] == 'there'", {"table"}),
        ("self.table.get('phase') == 'there'", {"table"}),
        ("len(self.many) > self.level", {"many", "level"}),
        ("all(each > 3 for each in self.many)", {"many"}),
        ("[each for each in self.many if each > self.level]", {"many", "level"}),
        ("f'{self.level}' == '3'", {"level"}),
        ("self.there if self.level else False", {"there", "level"}),
        ("(level := self.level) > 3", {"level"}),
        ("self.is_there", {"there"}),
        ("self.distance(5.0) < 0.1", {"pose"}),
        ("self.distance(5.0, self.level) < 0.1", {"pose", "level"}),
        ("self.branches()", {"there", "level"}),
        ("self.arrived.is_set()", {"arrived"}),
        ("self.lifted.is_set()", {"lifted"}),
        ("self.words.qsize() > self.level", {"words", "level"}),
        ("message > self.level", {"level"}),
        ("self.nav.has_arrived", {"nav.has_arrived"}),
        ("self.nav.is_done()", {"nav.has_arrived"}),
        ("self.nav.is_near(self.level)", {"nav.pose", "level"}),
        ("self.nav.nearly", {"nav.pose"}),
        ("self.nav.lifted.is_set() and self.there", {"nav.lifted", "there"}),
        ("self.nav.legs[0] > 3", {"nav.legs"}),
        ("self.level > math.pi", {"level"}),
    ],
)
async def test_conditions_that_are_understood(
    graphflow_runner: asyncio.Runner, written: Written, condition: str, attributes: set[str]
) -> None:
    """They are made of attributes, and of what stays as it is while the loop runs."""
    assert await read(written, polls(condition)) == (attributes, 0)


@pytest.mark.parametrize(
    "condition",
    [
        "time.time() > 3",
        "random.random() > 0.5",
        "own_function(self.level)",
        "self.thing",
        "self.odd",
        "self.objects.any()",
        "self.clock_says > 3",
        "self.draws()",
        "self.counts()",
        "self.loops()",
        "self.binds_its_argument(3)",
        "await self.asks()",
        "self.many.pop()",
        "self.distance(x=5.0) < 0.1",
        "(lambda: self.there)()",
        "end.is_set()",
        "self.goal.cancel()",
        "self.goal.ended.cancelled()",
        "self.goal == self.there",
        "local(3) or self.there",
        "self.arrived.clear()",
        "self.nav",
        "self.nav.draws()",
        "self.nav.next.is_done()",
        "self.nav.lifted.clear()",
    ],
)
async def test_conditions_that_are_not(graphflow_runner: asyncio.Runner, written: Written, condition: str) -> None:
    """Of anything else in one nobody knows when it changes."""
    with pytest.raises(Unknown):
        await read(written, "local = own_function\nend = asyncio.Event()\n" + polls(condition))


@pytest.mark.parametrize(
    ("condition", "attributes"),
    [
        ("self.goal.done", {"goal"}),
        ("self.goal is not None and self.goal.done", {"goal"}),
        ("self.task.done()", {"task"}),
        ("self.there or self.goal.done", {"there", "goal"}),
    ],
)
async def test_tasks_of_the_nodes(
    graphflow_runner: asyncio.Runner, written: Written, condition: str, attributes: set[str]
) -> None:
    """A goal or task that the node keeps may end the loop by its own end, too."""
    assert await read(written, polls(condition)) == (attributes, 1)


LOOPS = {
    "breaks": ("while True:\n    if self.there:\n        break\n    await pause()", {"there"}),
    "returns": ("while True:\n    if self.there:\n        return\n    await pause()", {"there"}),
    "raises": ("while True:\n    if self.there:\n        raise ValueError\n    await pause()", {"there"}),
    "asserts": ("while True:\n    assert not self.there\n    await pause()", {"there"}),
    "both": ("while not self.there:\n    if self.level > 3:\n        break\n    await pause()", {"there", "level"}),
    "guards around guards": (
        "while True:\n    if self.there:\n        if self.level > 3:\n            break\n    await pause()",
        {"there", "level"},
    ),
    "else of a guard": (
        "while True:\n    if self.there:\n        pass\n    elif self.level > 3:\n        break\n    await pause()",
        {"there", "level"},
    ),
    "turns again": (
        "while True:\n    await pause()\n    if not self.there:\n        continue\n    break",
        {"there"},
    ),
    "an inner loop's break": (
        "while not self.there:\n    for _ in (1, 2):\n        break\n    await pause()",
        {"there"},
    ),
    "for ever": ("while True:\n    await pause()", set[str]()),
}


@pytest.mark.parametrize("name", LOOPS)
async def test_ways_out_of_a_loop(graphflow_runner: asyncio.Runner, written: Written, name: str) -> None:
    """All conditions under which it is left count, but not those of a loop inside of it."""
    body, attributes = LOOPS[name]

    assert await read(written, body) == (attributes, 0)


@pytest.mark.parametrize(
    "body",
    [
        "while True:\n    await pause()\n    break",
        "while True:\n    match self.level:\n        case 4:\n            break\n    await pause()",
        "while True:\n    try:\n        await pause()\n    except OSError:\n        if self.there: break",
    ],
)
async def test_ways_out_that_are_not_understood(graphflow_runner: asyncio.Runner, written: Written, body: str) -> None:
    """One without a condition, or with one that is no expression."""
    with pytest.raises(Unknown):
        await read(written, body)


@pytest.mark.parametrize(
    ("before", "inside", "condition"),
    [
        ("limit = 3", "", "self.level > limit"),
        ("", "now = self.level", "now > 3"),
        ("", "a = self.level; b = a + 1", "b > 3"),
        ("", "a, b = self.level, 3", "a > b"),
        ("", "a: int = self.level", "a > 3"),
        ("limits = (3, 4)", "", "self.level in limits"),
        ("limits = [3, 4]", "print(limits[0], len(limits))", "self.level in limits"),
        ("limits = {'a': 3}", "print(limits.get('a'))", "self.level > limits['a']"),
        ("goal = Pose()", "print(goal); other = goal.x", "self.level > goal.x + 5"),
        ("goal = Pose()", "math.hypot(goal.x, own_function(goal.y))", "self.level > goal.x + 5"),
        ("goal = np.zeros(3)", "print(goal.sum())", "self.level > 5 + goal.max()"),
    ],
)
async def test_local_names(
    graphflow_runner: asyncio.Runner, written: Written, before: str, inside: str, condition: str
) -> None:
    """One that is not bound in the loop, and not changed, is constant; any other is what is bound to it."""
    body = f"{before}\nwhile True:\n    {inside}\n    if {condition}:\n        break\n    await pause()"

    assert await read(written, body) == ({"level"}, 0)


@pytest.mark.parametrize(
    ("before", "inside", "condition"),
    [
        ("n = 0", "n += 1", "n > 3"),
        ("n = 0", "n = n + 1", "n > 3"),
        ("", "for n in (0,): pass", "n"),
        ("end = False\ndef ends():\n    nonlocal end\n    end = True", "", "end"),
        ("said = []\nkeep = lambda: said.append(1)", "", "said"),
        ("said = []", "said.append(1)", "len(said) > 30"),
        ("said = []\nLIST.append(said)", "", "len(said) > 30"),
        ("said = []\nother = said", "", "said"),
        ("said = []\nkeep = said.append", "", "said"),
        ("said = [0]", "said[0] += 1", "said[0] > 30"),
        ("said = [[]]", "said[0].append(1)", "said[0]"),
        ("said = {}\nown_function(len(said)); LIST.append([said])", "", "said"),
        ("said = {}", "said['n'] = 3", "len(said) > 30"),
        ("goal = Pose()", "goal.x += 1.0", "goal.x > 30.0"),
        ("goal = Pose()\nLIST.append(goal)", "", "goal.x > 30.0"),
        ("goal = np.zeros(3)", "goal[0] += 1", "goal[0] > 30"),
        ("goal = np.zeros(3)", "goal.fill(3)", "goal[0] > 30"),
        ("goal = np.zeros(3)\nLIST.append(goal.T)", "", "goal[0] > 30"),
    ],
)
async def test_local_names_that_change(
    graphflow_runner: asyncio.Runner, written: Written, before: str, inside: str, condition: str
) -> None:
    """A counter; what a function inside can bind; a container, array or message that is changed or given away."""
    body = f"{before}\nwhile True:\n    {inside}\n    if self.there or {condition}:\n        break\n    await pause()"

    with pytest.raises(Unknown):
        await read(written, body)


async def test_a_message_that_the_condition_hands_on(graphflow_runner: asyncio.Runner, written: Written) -> None:
    """A method that only looks and reckons, as it is read there, may have it."""
    module = "goal = Pose()\nwhile not self.is_near(goal):\n    await pause()"

    assert await read(written, module) == ({"pose"}, 0)


MAKE = "asyncio.get_running_loop().create_task(pause())"


@pytest.mark.parametrize(
    ("body", "tasks"),
    [
        (f"task = {MAKE}\nwhile not task.done():\n    await pause()", 1),
        (f"tasks = [{MAKE} for _ in range(2)]\nwhile not all(t.done() for t in tasks):\n    await pause()", 2),
        (f"task = {MAKE}\nwhile not task.done():\n    print(task)\n    await pause()", 1),
    ],
)
async def test_tasks_of_the_functions(
    graphflow_runner: asyncio.Runner, written: Written, body: str, tasks: int
) -> None:
    """The loop is ended by tasks that only the function knows."""
    assert await read(written, body) == (set(), tasks)


@pytest.mark.parametrize(
    "body",
    [
        f"task = {MAKE}\nLIST.append(task)\nwhile not task.done():\n    await pause()",
        f"task = {MAKE}\nother = task\nwhile not task.done():\n    await pause()",
        f"task = {MAKE}\nwhile not task.done():\n    task.cancel()\n    await pause()",
        f"task = {MAKE}\nwhile not task.done():\n    await pause()\n    task = {MAKE}",
        "task = asyncio.get_running_loop().create_future()\nwhile not task.done():\n    await pause()",
    ],
)
async def test_tasks_that_others_know(graphflow_runner: asyncio.Runner, written: Written, body: str) -> None:
    """One that is handed on, cancelled or replaced in the loop, or made by somebody else."""
    with pytest.raises(Unknown):
        await read(written, body)


@pytest.mark.parametrize(
    ("expression", "makes"),
    [
        ("asyncio.create_task(x())", True),
        ("group.create_task(x())", True),
        ("asyncio.ensure_future(x())", True),
        ("[asyncio.create_task(x()) for _ in y]", True),
        ("[asyncio.create_task(x()), asyncio.ensure_future(y)]", True),
        ("(asyncio.create_task(x()), y)", False),
        ("await self.client.send_goal(x)", True),
        ("self.client.send_goal(x)", False),
        ("asyncio.gather(x())", False),
        ("x", False),
    ],
)
def test_what_makes_a_task(expression: str, makes: bool) -> None:
    """A call of what makes one, several of them, or a goal that was sent."""
    parsed = ast.parse(expression, mode="eval").body

    assert makes_task(parsed) is makes
