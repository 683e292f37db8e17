"""Attributes that are set, never read, and spelt almost as another one."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from graphflow import Node, Param
from graphflow.analysis.words import words_in
from graphflow.runtime.mistakes.source.stray_attributes import stray_attributes

FILE = Path("/nowhere/robot.py")
HEAD = """\
class Robot(Node):
    rate = Param(1.0)
    goal_x = Param(1.0)
    is_paused = False
    top_height: float = 2.0

    def read(self):
        return self.is_paused, self.rate, self.max_speed, self.top_height

    def __init__(self):
        self.max_speed = 1.0
        self.wheel_count = 4

    def work(self):
"""


def told(body: str) -> list[str]:
    """Return the sentences about a class whose method `work` has this body."""
    source = HEAD + "".join(f"        {line}\n" for line in body.splitlines())
    space: dict[str, type] = {"Node": Node, "Param": Param}
    exec(source, space)
    module = ast.parse(source)
    [definition] = module.body
    assert isinstance(definition, ast.ClassDef)
    return list(stray_attributes(space["Robot"], definition, str(FILE), words_in(module)))


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        *(("rat", "rate"), ("is_pased", "is_paused"), ("max_sped", "max_speed"), ("maxspeed", "max_speed")),
        ("top_heigth", "top_height"),
    ],
)
def test_it_is_told_with_the_one_that_was_meant(name: str, meant: str) -> None:
    """A parameter, an attribute of the class, one of another method."""
    [text] = told(f"self.{name} = 2.0")
    assert text == f"{FILE}:15: self.{name} is set and never read; did you mean self.{meant}?"


@pytest.mark.parametrize(
    "body",
    [
        "self.rats = 2.0\nreturn self.rats",
        "self.position = 2.0",
        "self.rates = []",
        "self.goal_y = 2.0",
        "self.min_speed = 1.0",
        "self.last_speed = 1.0",
        "self.max_sped = 1.0\nself.max_speed = 2.0",
        "self.ratio = 2.0",
        "self.wheel_cuont = 4",
        "class Part:\n    def __init__(self):\n        self.rat = 1.0",
    ],
)
def test_others_are_on_purpose(body: str) -> None:
    """Attributes may be read, resemble none that is read, differ as pairs do, or be set beside the other.

    What a class inside the node sets is not the node's.
    """
    assert told(body) == []
