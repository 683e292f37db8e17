"""Parameters that are read only at the start."""

from __future__ import annotations

import importlib.util
import itertools
import sys
from pathlib import Path

import pytest

from graphflow import Node
from graphflow.testing import Graph

Caplog = pytest.LogCaptureFixture

HEAD = """\
from graphflow import Node, Param, timer


class Car(Node):
    speed = Param(1.0)
"""
INIT = """
    def __init__(self):
        super().__init__()
        self.command = [self.speed]
"""
START = """
    async def on_start(self):
        speed = self.speed
        self.command = [speed]
"""
TICK = """
    @timer(1.0)
    def tick(self):
        self.log.debug("%s", self.command)
"""
_numbers = itertools.count()


def _car(folder: Path, code: str) -> Node:
    name = f"read_once_{next(_numbers)}"
    file = folder / f"{name}.py"
    file.write_text(code)
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None
    assert spec.loader is not None
    sys.modules[name] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    made: Node = module.Car()
    return made


def _told(caplog: Caplog) -> list[str]:
    return [text for text in caplog.messages if "without effect" in text]


@pytest.mark.parametrize(("first", "method"), [(INIT, "__init__"), (START, "on_start")])
async def test_a_parameter_that_is_set_without_effect(
    graph: Graph, caplog: Caplog, tmp_path: Path, first: str, method: str
) -> None:
    """Is told once, when its value changes, with the line that reads it."""
    car = _car(tmp_path, HEAD + first + TICK)
    await graph.start(car)
    car.parameters.set({"speed": 1.0})
    assert _told(caplog) == []
    for speed in (3.0, 4.0):
        car.parameters.set({"speed": speed})
    (text,) = _told(caplog)
    assert text.partition(".py:")[2] == (
        f"{'9' if first == INIT else '8'}: 'speed' is set without effect, since only {method} reads it; read "
        "self.speed where it is used, or declare it with read_only=True"
    )


@pytest.mark.parametrize(
    "code",
    [
        HEAD + INIT + TICK.replace("self.command", "self.speed"),
        HEAD + INIT + TICK.replace("1.0", "hz=speed"),
        HEAD + INIT + TICK + "    @speed.on_change\n    def changed(self, old, new): ...\n",
        HEAD + INIT.replace("[self.speed]", "lambda: self.speed") + TICK,
        HEAD + INIT + TICK.replace("self.command", "self.parameters.get('speed')"),
        HEAD + INIT + TICK + "    def other(self):\n        return {'speed': 2.0}\n",
        HEAD + INIT + TICK + "class Meter:\n    def read(self, car):\n        return car.speed\n",
        HEAD + INIT + TICK + "class Meter:\n    def read(self, car, name):\n        return getattr(car, name)\n",
        HEAD + START.replace("speed = self.speed", "while (speed := self.speed) < 0.5: pass") + TICK,
        HEAD + TICK.replace("self.command", "1"),
        HEAD.replace("1.0", "1.0, name='pace'") + INIT + TICK + "    other = 'pace'\n",
    ],
)
async def test_parameters_that_are_read_later(graph: Graph, caplog: Caplog, tmp_path: Path, code: str) -> None:
    """By a handler, a timer's rate, a follower, a function, another object, or nobody."""
    car = _car(tmp_path, code)
    await graph.start(car)
    car.parameters.set({"pace" if "pace" in car.parameters else "speed": 3.0})
    assert _told(caplog) == []


async def test_a_parameter_that_another_module_reads(graph: Graph, caplog: Caplog, tmp_path: Path) -> None:
    """It has its effect there."""
    car = _car(tmp_path, HEAD + INIT + TICK)
    (tmp_path / "meter.py").write_text("def read(car):\n    return car.speed\n")
    spec = importlib.util.spec_from_file_location("read_once_meter", tmp_path / "meter.py")
    assert spec is not None
    sys.modules["read_once_meter"] = importlib.util.module_from_spec(spec)
    try:
        await graph.start(car)
        car.parameters.set({"speed": 3.0})
        assert _told(caplog) == []
    finally:
        del sys.modules["read_once_meter"]
