"""Attributes that keep a parameter's first value."""

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
from graphflow import Node, timer


class Car(Node):
    def __init__(self):
        super().__init__()
        self.speed = self.declare_parameter("speed", 1.0)
"""
TICK = """
    @timer(1.0)
    def tick(self):
        self.log.debug("%.1f", self.speed)
        self.log.debug("on")
"""
_numbers = itertools.count()


def _car(folder: Path, code: str) -> Node:
    name = f"copies_{next(_numbers)}"
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
    return [text for text in caplog.messages if "keeps the value" in text]


async def test_a_parameter_that_is_set_without_effect(graph: Graph, caplog: Caplog, tmp_path: Path) -> None:
    """Is told once, with the line of the copy."""
    car = _car(tmp_path, HEAD + TICK)
    await graph.start(car)
    assert _told(caplog) == []
    for speed in (3.0, 4.0):
        car.parameters.set({"speed": speed})
    (text,) = _told(caplog)
    assert text.endswith(
        ".py:7: self.speed keeps the value that 'speed' had at the start, and the node goes on with 1.0; read "
        'self.parameters.get("speed") where it is used, or declare speed = Param(...) in the class'
    )


@pytest.mark.parametrize(
    "code",
    [
        HEAD + TICK.replace("self.speed)", 'self.parameters.get("speed"))'),
        HEAD + "        self.parameters.observe(self.changed)\n    def changed(self, changes): ...\n" + TICK,
        HEAD + "        self.log.info('%.1f', self.speed)\n",
        HEAD + TICK + "        self.speed = 0.9 * self.speed\n",
        HEAD.replace("self.speed =", "self.first =") + TICK.replace("self.speed", "self.parameters.get('speed')"),
        'from graphflow import Node, Param\nclass Car(Node):\n    speed = Param(1.0)\n    first = "speed"\n',
    ],
    ids=["read anew", "observed", "used at the start", "set later", "only the first", "Param"],
)
async def test_nodes_that_follow_it(graph: Graph, caplog: Caplog, tmp_path: Path, code: str) -> None:
    """Are not told, nor those that use it at the start only."""
    car = _car(tmp_path, code)
    await graph.start(car)
    car.parameters.set({"speed": 3.0})
    assert _told(caplog) == []
