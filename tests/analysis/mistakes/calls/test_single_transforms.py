"""Transforms that are sent once and change."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.single_transforms import single_transforms

NATIVE = """
class Camera(Node):
    tf = Transforms()

    async def on_start(self):
        {}

    @timer(1.0)
    async def tick(self):
        {}
"""
RCLPY = """
class Camera(Node):
    def __init__(self):
        super().__init__('camera')
        self.broadcaster = TransformBroadcaster(self)
        self.make_transforms()

    def make_transforms(self):
        self.broadcaster.sendTransform(TransformStamped())
"""
SEND = "self.tf.send(Transform.of('base', 'camera', (0.1, 0, 0)))"


def test_a_transform_of_the_start() -> None:
    """The sentence has the method for those that never change."""
    [(line, text)] = single_transforms(ast.parse(NATIVE.format(SEND, "await self.tf.lookup('map', 'base')")))
    assert line == 6
    assert text.startswith("self.tf.send runs once, and its transform holds for that moment alone; ")
    assert "for one that never changes, write self.tf.send_static; send others again" in text


def test_a_transform_of_a_method_that_the_start_calls() -> None:
    """As that of the tutorial for static ones does."""
    [(line, text)] = single_transforms(ast.parse(RCLPY))
    assert line == 9
    assert "take a StaticTransformBroadcaster" in text


@pytest.mark.parametrize(
    ("start", "tick"),
    [
        (SEND, SEND),
        ("pass", SEND),
        ("self.tf.send_static(one)", "pass"),
        ("await self.tick()", SEND),
        ("while True:\n            " + SEND, "pass"),
        ("for _ in range(9):\n            " + SEND, "pass"),
        ("async for _ in self.clock.every(1.0):\n            " + SEND, "pass"),
        ("self.later(lambda: " + SEND + ")", "pass"),
        ("def later():\n            " + SEND + "\n        self.create_timer(1.0, later)", "pass"),
    ],
)
def test_transforms_that_are_sent_again(start: str, tick: str) -> None:
    """In a timer, though the start calls its handler, too; in a loop, or in a function that others call."""
    assert not list(single_transforms(ast.parse(NATIVE.format(start, tick))))


@pytest.mark.parametrize(
    ("start", "tick"),
    [
        (SEND, "use(self.tf)"),
        (SEND, "self.other.tf.send(one)"),
        ("self.other.tf.send(one)", "pass"),
        ("all(" + SEND + " for one in ones)", "pass"),
    ],
)
def test_transforms_that_may_be_sent_again(start: str, tick: str) -> None:
    """By code that they are passed to, or by the other node that has them."""
    assert not list(single_transforms(ast.parse(NATIVE.format(start, tick))))


@pytest.mark.parametrize(
    "line", ["self.create_timer(1.0, self.make_transforms)", "[self.make_transforms() for _ in others]"]
)
def test_methods_that_run_again(line: str) -> None:
    """As a timer's callback does, or what a loop calls."""
    assert not list(single_transforms(ast.parse(RCLPY.replace("self.make_transforms()", line))))


BESIDE = """
class Odometry(Node):
    tf = Transforms()

    async def on_start(self):
        self.tf.send(Transform.of("base_link", {laser}, (0.1, 0.0, 0.2)))

    @subscription(Pose, "pose")
    async def moved(self, pose):
        self.tf.send({moving})
"""


@pytest.mark.parametrize(
    ("laser", "moving", "is_told"),
    [
        ('"laser"', 'Transform.of("odom", "base_link", (pose.x, 0.0, 0.0))', True),
        ('"laser"', 'Transform.of("odom", "laser", (pose.x, 0.0, 0.0))', False),
        ('"laser"', "self.where(pose)", False),
        ("self.laser", 'Transform.of("odom", "base_link", (pose.x, 0.0, 0.0))', False),
    ],
)
def test_one_beside_those_that_are_sent_often(laser: str, moving: str, is_told: bool) -> None:
    """It is of another frame, as far as the source shows both."""
    found = list(single_transforms(ast.parse(BESIDE.format(laser=laser, moving=moving))))
    assert [line for line, _ in found] == ([6] if is_told else [])
