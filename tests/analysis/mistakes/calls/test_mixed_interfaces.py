"""graphflow's declarations in rclpy's nodes."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.mixed_interfaces import mixed_interfaces

SOURCE = """
from {}
from graphflow import Param, timer

class Talker(Node):
    word = Param("hi")

    @timer(1.0)
    def tick(self):
        pass
"""


@pytest.mark.parametrize("words", ["rclpy.node import Node", "rclpy.lifecycle import LifecycleNode as Node"])
def test_a_node_of_rclpy(words: str) -> None:
    """Each declaration is reported with rclpy's equivalent, and with the class that would read it."""
    found = dict(mixed_interfaces(ast.parse(SOURCE.format(words))))
    assert found == {
        6: "graphflow's Param has no effect in a node of rclpy: write self.declare_parameter(...) in __init__, "
        "or derive Talker from graphflow.Node",
        8: "graphflow's timer has no effect in a node of rclpy: write self.create_timer(...) in __init__, "
        "or derive Talker from graphflow.Node",
    }


def test_a_declaration_by_another_name() -> None:
    """An import with `as` does not hide it."""
    source = SOURCE.replace("Param, timer", "Param as Word, timer").replace("= Param(", "= Word(")
    [text, _] = dict(mixed_interfaces(ast.parse(source.format("rclpy.node import Node")))).values()
    assert text.startswith("graphflow's Param has no effect in a node of rclpy")


def test_a_node_by_another_name() -> None:
    """The name that rclpy has for a class decides."""
    source = SOURCE.replace("(Node)", "(Base)").format("rclpy.node import Node as Base")
    assert len(list(mixed_interfaces(ast.parse(source)))) == 2


def test_declarations_of_others() -> None:
    """A decorator of another module may be called `timer`, too."""
    source = SOURCE.replace("from graphflow import", "from profiling import").format("rclpy.node import Node")
    assert not list(mixed_interfaces(ast.parse(source)))


def test_a_native_node() -> None:
    """It is what the declarations are for."""
    assert not list(mixed_interfaces(ast.parse(SOURCE.format("graphflow import Node"))))
