"""Publishers to which a node publishes only at its start."""

from __future__ import annotations

import importlib.util
import itertools
import sys
from pathlib import Path
from types import ModuleType

import pytest

from graphflow.runtime.mistakes.source.single_sends import single_sends

HEAD = """\
from graphflow import Node, Publisher, task
from graphflow.msgs.std_msgs.msg import String


class Server(Node):
    {out} = Publisher(String, "map")

"""
START = "    async def on_start(self):\n"
SEND = "        self.out.publish(String())\n"
_numbers = itertools.count()


def _module(folder: Path, out: str, body: str) -> ModuleType:
    name = f"single_{next(_numbers)}"
    file = folder / f"{name}.py"
    file.write_text(HEAD.format(out=out) + body)
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None
    assert spec.loader is not None
    sys.modules[name] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _lines(folder: Path, body: str) -> list[int | None]:
    out = f"out_{next(_numbers)}"
    node = _module(folder, out, body.replace("self.out", f"self.{out}").replace("node.out", f"node.{out}")).Server()
    return [place.line for place in single_sends(node, getattr(node, out))]


def test_on_start_and_tasks(tmp_path: Path) -> None:
    """Publish once per line, also under a condition."""
    start = f"{START}        if self.name:\n    {SEND}"
    task = f"    @task\n    async def run_it(self):\n        await self.clock.sleep(1.0)\n{SEND}"
    assert _lines(tmp_path, start) == [10]
    assert _lines(tmp_path, start + task) == [10, 14]


@pytest.mark.parametrize(
    "body",
    [
        f"{START}        while True:\n    {SEND}",
        f"{START}        [self.out.publish(String()) for _ in range(3)]\n",
        f"{START}        def later():\n    {SEND}        later()\n",
        f"{START}        await self.out.wait_matched()\n{SEND}",
        f"{START}        send = self.out.publish\n        send(String())\n",
        f"{START}        getattr(self, 'o' + 'ut').publish(String())\n",
        f"{START}{SEND}\n    def again(self):\n{SEND}",
        f"{START}{SEND}\n\ndef other(node):\n    node.out = node.out\n",
        f"    @task\n    async def go(self):\n{SEND}\n    async def again(self):\n        await self.go()\n",
        "    pass\n",
    ],
)
def test_whatever_may_publish_again(tmp_path: Path, body: str) -> None:
    """Makes it unknown: loops, other methods, other uses of the publisher, and calls of the task."""
    assert _lines(tmp_path, body) == []


def test_a_publisher_of_another_node(tmp_path: Path) -> None:
    """Is unknown."""
    node = _module(tmp_path, "out_of_one", "    async def on_start(self):\n        pass\n").Server()
    assert single_sends(node, object()) == []
