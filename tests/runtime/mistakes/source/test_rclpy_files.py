"""Slips in files that are written for rclpy."""

from __future__ import annotations

import ast

from graphflow.runtime.mistakes.source.rclpy_files import slips_in_file

FILE = """
class Lamp(Node):
    def heard(self, message):
        self.ready.set
        self.count + 1
        Thread(target=self.work()).start()

    def work(self):
        print("works")
"""


def test_slips_of_each_kind() -> None:
    """Each has its line; a file without any has none."""
    assert [(line, text.partition(";")[0]) for line, text in slips_in_file(ast.parse(FILE))] == [
        (4, "self.ready.set without parentheses calls nothing"),
        (5, "self.count + 1 computes without effect"),
        (6, "target=self.work() calls work at once, and passes on its result, None"),
    ]
    assert list(slips_in_file(ast.parse("class Lamp(Node):\n    def heard(self, message):\n        self.go()\n"))) == []
