"""Names that belong to a class and are used without it."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import pytest

from graphflow.runtime.mistakes.errors.python_errors import remark_on

HEAD = """\
import graphflow
from graphflow import Group, Node, Param, timer

class Base(Node):
    motion = Group(1)
    gain = Param(5.0)

class Bases:
    Base = Base
"""
PARENT = "a class body does not see its parent's names: write {}.motion"


def remark(tmp_path: Path, more: str) -> str:
    """Return the advice on the NameError of a module with these lines."""
    file = tmp_path / "names_module.py"
    file.write_text(HEAD + more)
    spec = importlib.util.spec_from_file_location("names_module", file)
    assert spec is not None
    assert spec.loader is not None
    module: Any = importlib.util.module_from_spec(spec)
    with pytest.raises(NameError) as caught:
        spec.loader.exec_module(module)
    return remark_on(caught.value)


TICK = "    @timer(1.0, group=motion)\n    async def tick(self) -> None: ...\n"


@pytest.mark.parametrize(
    ("more", "told"),
    [
        (f"class N(Base):\n{TICK}", PARENT.format("Base")),
        (f"class N(Bases.Base):\n{TICK}", PARENT.format("Bases.Base")),
        (
            f"def make():\n    class N(Base):\n    {TICK.replace('    async', '        async')}\nmake()",
            PARENT.format("Base"),
        ),
        (f"class N(Node):\n{TICK}", ""),
        ("class N(Node):\n    rate = 2\n    half = self.rate / 2", "a class body has no self: write rate"),
        ("class N(Node):\n    near = [self.rate for _ in 'a']", ""),
        ("self.rate = 2", "only methods have self: move the line into one"),
        (
            "def turn():\n    self.rate = 2\nturn()",
            "turn is no method: indent it below its class as def turn(self, ...), or give it the node",
        ),
        (
            "class N(Node):\n    def turn(slef):\n        self.rate = 2\nN.turn(1)",
            "the first parameter of turn is called slef: call it self",
        ),
        (
            "class N(Node):\n    @staticmethod\n    def turn():\n        self.rate = 2\nN.turn()",
            "turn has no parameters: write def turn(self), without @staticmethod",
        ),
        ("Duration.of(2.0)", "write from graphflow import Duration"),
        (
            "x = Duration",
            "write from graphflow import Duration or from graphflow.msgs.builtin_interfaces.msg import Duration",
        ),
        ("class N(Base):\n    def work(self):\n        return 2 * gain\nN().work()", "write self.gain"),
        ("class N(Base):\n    def work(self):\n        return 2 * gian\nN().work()", ""),
        ("motion", ""),
        ("Vector3()", "write from graphflow.msgs.geometry_msgs.msg import Vector3"),
        ("Transforms()", "write from graphflow.tf import Transforms"),
        ("@subscription(1, 'x')\ndef f(m): ...", "write from graphflow import subscription"),
        ("math.sin(1.0)", "write import math"),
        ("np.zeros(2)", "write import numpy as np"),
        ("class N(Base):\n    count = 0\n    def work(self):\n        count += 1\nN().work()", "write self.count"),
        (
            "class N(Base):\n    count = 0\n    def work(self):\n        count = count + 1\nN().work()",
            "write self.count",
        ),
        ("class N(Base):\n    count = 0\n    def work(self):\n        n += 1\nN().work()", ""),
        (
            "n = 0\nclass N(Base):\n    def work(self):\n        print(n)\n        n += 1\nN().work()",
            "line 14 sets n, which makes it local: write global n at the top of work",
        ),
        (
            "n = 0\ndef work():\n    n += 1\nwork()",
            "this line sets n, which makes it local: write global n at the top of work",
        ),
        (
            "def work():\n    if not sys:\n        n = 1\n    print(n)\nwork()".replace("sys", "Base"),
            "only line 12 sets it, and has not run",
        ),
        ("class N(Base):\n    count = 0\n    def work(self):\n        print(count)\n        count = 1\nN().work()", ""),
    ],
)
def test_names_of_classes(tmp_path: Path, more: str, told: str) -> None:
    """The advice has their class, or self."""
    found = remark(tmp_path, more)
    assert found.endswith(told) if told else found == ""
