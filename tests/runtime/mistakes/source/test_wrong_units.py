"""Parameters in another unit than the call takes."""

from __future__ import annotations

import ast

import pytest

from graphflow import Client, Node, Param
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.runtime.mistakes.source.wrong_units import wrong_units


class Robot(Node):
    rate = Param(10.0, unit="Hz")
    pause = Param(500, unit="ms")
    patience = Param(2.0, unit="s")
    speed = Param(1.0, unit="m/s")
    plain = Param(1.0)
    turn = Param(30.0, unit="deg/s")
    adder = Client(AddTwoInts, "add")


def _told(line: str) -> list[tuple[int, str]]:
    definition = ast.parse(f"class Robot(Node):\n    async def go(self):\n        {line}").body[0]
    assert isinstance(definition, ast.ClassDef)
    return list(wrong_units(Robot, definition))


@pytest.mark.parametrize(
    ("line", "told"),
    [
        (
            "await self.clock.sleep(self.pause)",
            'sleep takes seconds, and self.pause is in ms; write pause = Param(0.5, unit="s")',
        ),
        ("await asyncio.sleep(self.rate)", "sleep takes seconds, and self.rate is in Hz; write 1.0 / self.rate"),
        (
            "async for n in self.clock.every(self.rate): ...",
            "every takes seconds, and self.rate is in Hz; write hz=self.rate",
        ),
        (
            "async for n in self.clock.every(hz=self.patience): ...",
            "hz= of every takes Hz, and self.patience is in s; write every(self.patience)",
        ),
        (
            "self.create_timer(self.rate, self.go)",
            "create_timer takes seconds, and self.rate is in Hz; write 1.0 / self.rate",
        ),
        (
            "await self.adder.call(request, timeout=self.pause)",
            'timeout= of call takes seconds, and self.pause is in ms; write pause = Param(0.5, unit="s")',
        ),
    ],
)
def test_a_parameter_in_another_unit(line: str, told: str) -> None:
    """Is told with the line and the right form."""
    assert _told(line) == [(3, told)]


@pytest.mark.parametrize(
    "line",
    [
        "await self.clock.sleep(self.pause / 1000)",
        "await self.clock.sleep(self.patience)",
        "await self.clock.sleep(self.plain)",
        "await self.clock.sleep(1.0 / self.rate)",
        "await self.adder.call(request, timeout=self.patience)",
        "async for n in self.clock.every(hz=self.rate): ...",
        "self.port = Serial('/dev/ttyS0', timeout=self.pause)",
        "self.poller.poll(self.pause)",
        "await other.clock.sleep(other.pause)",
    ],
)
def test_what_is_right_or_unknown(line: str) -> None:
    """Is not told."""
    assert _told(line) == []


@pytest.mark.parametrize(
    ("line", "is_told"),
    [
        ("self.cmd.publish(Twist(angular=Vector3(z=self.turn)))", True),
        ("twist.angular.z = self.turn", True),
        ("y = math.sin(self.turn)", True),
        ("self.go(yaw=self.turn)", True),
        ("twist.angular.z = math.radians(self.turn)", False),
        ("twist.linear.x = self.turn", False),
        ("twist.angular.z = self.plain", False),
    ],
)
def test_degrees(line: str, is_told: bool) -> None:
    """They are told where radians are taken."""
    way = "self.turn is in deg/s, and radians are taken here; write math.radians(self.turn)"
    assert [text for _, text in _told(line)] == ([way] if is_told else [])
