"""Parameters that only a constructor reads."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterValue
from rcl_interfaces.srv import SetParameters

from rclpy.impl.mistakes.read_once import without_effect
from rclpy.node import Node
from tests.written import Written

Caplog = pytest.LogCaptureFixture

HEAD = """\
from rclpy.node import Node


class Car(Node):
    def __init__(self):
        super().__init__("car")
        self.declare_parameter("speed", 1.0)
"""
KEEP = '        self.speed = self.get_parameter("speed").value\n'
TICK = "    def tick(self):\n        print(self.speed)\n"


def set_by_others(node: Any, value: float) -> bool:
    message = ParameterMessage(name="speed", value=ParameterValue(type=3, double_value=value))
    response = node._graphflow_serve_set(SetParameters.Request(parameters=[message]), SetParameters.Response())
    return bool(response.results[0].successful)


def told(caplog: Caplog) -> list[str]:
    return [text for text in caplog.messages if "without effect" in text]


def test_a_parameter_that_is_set_without_effect(node: Node, caplog: Caplog, written: Written) -> None:
    """It is told once, with the line of the read, when another process has changed it."""
    make: Callable[[], Node] = written(HEAD + KEEP + TICK).Car
    car = make()
    assert set_by_others(car, 1.0)
    assert told(caplog) == []
    assert set_by_others(car, 2.0)
    assert set_by_others(car, 3.0)
    [text] = told(caplog)
    assert text.endswith(
        ".py:8: 'speed' is set without effect, since only the constructor reads it; read "
        "self.get_parameter('speed').value where it is used, or follow it with add_on_set_parameters_callback"
    )


@pytest.mark.parametrize(
    ("code", "line"),
    [
        (HEAD + "        self.read()\n    def read(self):\n" + KEEP, 10),
        (HEAD.replace('        self.declare_parameter("speed", 1.0)\n', "")
         + '        self.speed = self.declare_parameter("speed", 1.0).value\n', 7),
        (HEAD + '        self.speed = float(self.get_parameter("speed").value)\n', 8),
        (HEAD + '        self.create_timer(self.get_parameter("speed").value, self.tick)\n' + TICK, 8),
    ],
    ids=["by a helper", "at the declaration", "converted", "passed on"],
)  # fmt: skip
def test_other_ways_to_read_it_once(code: str, line: int, written: Written) -> None:
    """They are told with their line."""
    assert f".py:{line}: 'speed' is set without effect" in without_effect(written(code).Car, "speed")


@pytest.mark.parametrize(
    "lines",
    [
        '        self.create_timer(self.get_parameter("speed").value, self.tick)\n',
        KEEP + "        self.create_timer(1.0 / self.speed, self.tick)\n",
        '        speed = self.get_parameter("speed").value\n        period = 1 / speed\n'
        "        self.timer = self.create_timer(period, self.tick)\n",
    ],
)
def test_a_period_that_is_read_once(lines: str, written: Written) -> None:
    """A timer keeps it, wherever it is read."""
    text = without_effect(written(HEAD + lines + "    def tick(self):\n        pass\n").Car, "speed")
    assert text.endswith(
        ".py:8: 'speed' is set without effect, since a timer keeps its period; make a new one in a callback of "
        "add_on_set_parameters_callback, or start again with --ros-args -p speed:=VALUE"
    )


@pytest.mark.parametrize(
    "code",
    [
        HEAD + TICK,
        HEAD + KEEP + TICK + '        self.get_parameter("speed")\n',
        HEAD + KEEP + "        self.add_on_set_parameters_callback(self.changed)\n" + TICK,
        HEAD + KEEP + TICK + "        self.get_parameter(self.name)\n",
        HEAD + "        self.create_timer(1.0, self.read)\n        self.read()\n    def read(self):\n" + KEEP,
        HEAD + "        self.read()\n    def read(self):\n" + KEEP + "    def tick(self):\n        self.read()\n",
        HEAD + "        def read():\n    " + KEEP + "        self.create_timer(1.0, read)\n",
        HEAD + "        while True:\n    " + KEEP,
    ],
    ids=["never", "later", "followed", "by a variable", "a callback", "called later", "a function", "a loop"],
)
def test_what_may_be_read_again(code: str, written: Written) -> None:
    """It is not told, nor is a parameter that nothing reads."""
    assert without_effect(written(code).Car, "speed") == ""
