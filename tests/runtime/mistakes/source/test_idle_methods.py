"""Methods that nothing calls, and that would take part in the graph."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from graphflow.analysis.syntax import syntax_of
from graphflow.runtime.mistakes.source.idle_methods import idle_methods
from graphflow.runtime.mistakes.source.shadowing import definition_of

HEAD = """\
from graphflow import Client, Node, Param, Publisher, action
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import Int32
from graphflow.msgs.std_srvs.srv import Trigger


class Robot(Node):
    rate = Param(1.0)
    out = Publisher(Int32, "out")
    ask = Client(Trigger, "ask")

"""
Told = Callable[[str], list[str]]


@pytest.fixture
def told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Told:
    """Finds such methods in a class with these lines, without the place."""

    def found(body: str) -> list[str]:
        file = tmp_path / "idle_module.py"
        file.write_text(HEAD + "".join(f"    {line}\n" for line in body.splitlines()))
        spec = importlib.util.spec_from_file_location("idle_module", file)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, "idle_module", module)
        spec.loader.exec_module(module)
        definition = definition_of(module.Robot)
        assert definition is not None
        syntax = syntax_of(str(file)).module
        return [text.partition(": ")[2] for text in idle_methods(module.Robot, *definition, syntax, vars(module))]

    return found


@pytest.mark.parametrize(
    ("body", "text"),
    [
        (
            "async def drive(self):\n    self.out.publish(Int32())",
            "nothing calls Robot.drive, which uses self.out: write @timer(1.0) or @task above it, or call it",
        ),
        (
            "async def command(self):\n    while True:\n        await self.ask.call()",
            "nothing calls Robot.command, which uses self.ask: write @timer(1.0) or @task above it, or call it",
        ),
        (
            "async def walk(self, goal: Fibonacci.Handle):\n    return Fibonacci.Result()",
            'nothing calls Robot.walk, which looks like a handler: declare it, as with @action(Type, "name") above it',
        ),
        (
            "async def number(self, number: Int32):\n    self.log.info('%s', number.data)",
            "nothing calls Robot.number, which looks like a handler: "
            'declare it, as with @subscription(Type, "topic") above it',
        ),
    ],
)
def test_methods_that_are_meant_to_be_called(told: Told, body: str, text: str) -> None:
    """They use what connects a node with others, or take a goal."""
    assert told(body) == [text]


@pytest.mark.parametrize(
    "body",
    [
        "async def drive(self):\n    self.out.publish(Int32())\nasync def go(self):\n    await self.drive()",
        "async def _drive(self):\n    self.out.publish(Int32())",
        "async def drive(self, speed):\n    self.out.publish(Int32())",
        "@property\ndef drive(self):\n    return self.out.publish(Int32())",
        "def drive(self):\n    return self.rate",
        "def handle_outlier(self, reason: str): ...",
        "def drive(self):\n    other.out.publish(Int32())",
        "def drive(self):\n    self.out.publish(Int32())\nrun = drive",
        "def can(self, goal: Fibonacci.Goal):\n    return True\n"
        '@action(Fibonacci, "count", accept=can)\nasync def count(self, goal: Fibonacci.Handle): ...',
        "def go(self):\n    getattr(self, f'on_{self.rate}')()\ndef on_idle(self): ...",
        "def go(self):\n    getattr(self, 'on_' + self.rate)()\ndef on_idle(self): ...",
        "def go(self):\n    getattr(self, f'{self.rate}_callback')()\ndef a_callback(self): ...",
    ],
)
def test_methods_of_others(told: Told, body: str) -> None:
    """Methods that are called, private, take arguments, or take no part in the graph are left alone."""
    assert told(body) == []


def test_a_method_that_an_installed_package_calls(told: Told, tmp_path: Path) -> None:
    """Is another one of that name."""
    installed = tmp_path / "venv" / "user.py"
    installed.parent.mkdir()
    installed.write_text("await robot.drive()\n")
    body = "async def drive(self):\n    self.out.publish(Int32())"
    assert len(told(body)) == 1


@pytest.mark.parametrize("text", ["def drive(): ...", "drive = 1", "class Other:\n    async def drive(self): ..."])
def test_another_file_with_the_name(told: Told, tmp_path: Path, text: str) -> None:
    """It calls nothing by it."""
    (tmp_path / "other.py").write_text(f"{text}\n")
    assert len(told("async def drive(self):\n    self.out.publish(Int32())")) == 1


def test_a_method_that_another_file_calls(told: Told, tmp_path: Path) -> None:
    """It counts, though nothing has loaded it."""
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_robot.py").write_text("async def test(robot): await robot.drive()\n")
    assert told("async def drive(self):\n    self.out.publish(Int32())") == []
