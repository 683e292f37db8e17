"""Programs of a graph, as `graphflow check` reads them."""

from __future__ import annotations

import json
from pathlib import Path

from tests.conftest import Machine

LAMP = """\
import rclpy
from rclpy.node import Node


class Lamp(Node):
    def __init__(self):
        super().__init__("lamp")
        self.create_timer(1.0, self.tick)

    def tick(self):
        self.timer.cancel

def main():
    rclpy.init()
    rclpy.spin(Lamp())
"""
GRAPH = """\
nodes:
  /lamp: {pkg: lamp, exec: lamp}
  /file: {exec: lamp/lamp/node.py}
  /clock: {command: [sleep, "60"]}
"""


def test_programs_of_a_graph(machine: Machine, tmp_path: Path) -> None:
    """Those for rclpy are read, each file once; others are counted, and not called right."""
    package = tmp_path / "lamp"
    (package / "lamp").mkdir(parents=True)
    (package / "package.xml").write_text("<package format='3'><name>lamp</name><version>0.1.0</version></package>")
    (package / "setup.py").write_text(
        "from setuptools import setup\n"
        "setup(name='lamp', entry_points={'console_scripts': ['lamp = lamp.node:main']})\n"
    )
    (package / "lamp" / "__init__.py").touch()
    (package / "lamp" / "node.py").write_text(LAMP)
    (tmp_path / "g.yaml").write_text(GRAPH)
    text = machine.look("check", "g.yaml", cwd=tmp_path)
    assert text.count("node.py:11: self.timer.cancel without parentheses calls nothing") == 1
    assert text.endswith("g.yaml: 3 nodes, 0 steps, 1 remark, 1 program not checked\n")
    assert json.loads(machine.look("check", "--json", "g.yaml", cwd=tmp_path))["unread"] == ["/clock"]
    (package / "lamp" / "node.py").write_text(LAMP.replace("cancel", "cancel()"))
    assert machine.look("check", "g.yaml", cwd=tmp_path).endswith("0 steps, no problems, 1 program not checked\n")
