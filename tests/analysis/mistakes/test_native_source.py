"""Mistakes in the source of a node class."""

from __future__ import annotations

import ast

from graphflow.analysis.mistakes.native_source import slips

SOURCE = """\
class Robot(Node):
    def heard(self, message):
        if message == "go":
            self.timer.cancel
        self.state == "on"

class Other(Node):
    def tick(self):
        self.state == "off"
        return math.degrees(self.angle) > math.radians(90)
"""


def test_only_the_class_is_read() -> None:
    """The lines of other classes are left to them, also by the checks that read the whole file."""
    module = ast.parse(SOURCE)
    first, second = (node for node in module.body if isinstance(node, ast.ClassDef))
    assert sorted(line for line, _ in slips(first, module, {"heard": "String"})) == [3, 4, 5]
    assert sorted(line for line, _ in slips(second, module, {})) == [9, 10]


def test_only_callbacks_of_messages() -> None:
    """A method that receives no messages may compare its argument with text."""
    module = ast.parse(SOURCE)
    assert isinstance(module.body[0], ast.ClassDef)
    assert 3 not in dict(slips(module.body[0], module, {}))
